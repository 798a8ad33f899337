"""The course checks itself: what ``course author check`` proves, and what writes the blanks of a new part."""
