"""Ways to look at one world. Each view is imported only when it is used."""
