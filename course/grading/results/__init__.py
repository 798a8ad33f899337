"""What a class scored as it counts: newest gradings, overrides, lateness, and who everybody is."""
