"""``course grade``: what an instructor does with a class. Needs a checkout."""
