"""``course quiz``: five questions, an explanation of every option, and a review of missed questions."""
