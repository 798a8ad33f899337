"""Building the course's notebooks, cell by cell, and merging a newer notebook with an older one."""
