"""Deletes every function, so that nothing can fail."""

for name in ("scale", "advance", "sample", "compose", "double", "draw"):
    del globals()[name]
