"""Showing a verdict: on the screen, with printed output, and as lines for other programs."""
