"""One module for each engine, and a file with its options: defaults, effects, and the values tried."""
