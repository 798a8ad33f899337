"""Wrong: a source that nobody can open."""

_FACTS["bullet"]["licence"] = ("Zlib", "its README")
