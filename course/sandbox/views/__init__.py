"""Ways to look at one world. Each view is imported when it is asked for."""
