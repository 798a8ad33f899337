"""``course quiz``: five questions, an explanation for every option, and what was missed comes back."""
