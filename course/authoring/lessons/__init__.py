"""What the course checks of its lessons: prose, links, and every cell run with its recorded output."""
