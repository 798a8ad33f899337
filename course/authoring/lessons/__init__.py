"""How the course checks its lessons: prose, links, and every cell against its recorded output."""
