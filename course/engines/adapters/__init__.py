"""One file for each engine, and beside it its options: their defaults, what they do, what was tried."""
