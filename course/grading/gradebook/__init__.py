"""``gradebook.sqlite``, the one truth of a grading run: its file, what it holds, reading and writing it."""
