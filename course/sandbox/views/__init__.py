"""Views of one world. Each is imported only when it is used."""
