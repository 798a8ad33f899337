"""Wrong: a source that cannot be opened."""

_FACTS["bullet"]["licence"] = ("Zlib", "its README")
