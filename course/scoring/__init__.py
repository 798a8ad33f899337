"""One submission: what its checks find, and what mistake that shows."""
