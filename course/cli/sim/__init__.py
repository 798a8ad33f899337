"""``course sim``: simulations, and their numbers beside theory's."""
