"""``course sandbox``: scenes to play with, to run without a view, to film, to replay and to export."""
