"""``course sim``: simulations, with their numbers beside those of theory."""
