"""A package of its own, or that of an engine (`dartpy` installs a `tests`, too) would be taken for it."""
