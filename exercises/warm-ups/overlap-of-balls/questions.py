"""Calls that tell wrong programs of `overlap-of-balls` apart. What they should give is not here."""

QUESTIONS = {
    "overlap": [
        ([0.0, 0.0], [0.3, 0.4], 0.4, 0.3),
        ([1.0, -2.0], [4.0, 2.0], 1.5, 2.0),
        ([0.2, 0.1], [0.2, 0.3], 0.5, 0.1),
    ],
}
