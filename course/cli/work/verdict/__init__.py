"""A verdict shown: on the screen, with what was printed, and as lines for other programs."""
