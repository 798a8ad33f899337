"""``course sandbox``: scenes to play with, to run unseen, to film, to replay and to export."""
