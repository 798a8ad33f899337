"""The class as one HTML page, an index of its students, and a page per student to hand out."""
