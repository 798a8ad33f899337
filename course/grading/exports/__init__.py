"""Files made from a gradebook: nothing in them that is not in it."""
