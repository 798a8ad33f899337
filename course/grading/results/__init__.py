"""The scores of a class that count: newest gradings, overrides, lateness, and the students' identities."""
