"""``course lessons`` and ``course lesson``: what there is to read, and reading it."""
