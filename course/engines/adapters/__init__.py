"""One module for each engine, and a file with its options: their defaults, what they do, what was tried."""
