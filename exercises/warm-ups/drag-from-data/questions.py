"""Calls that tell wrong programs of `drag-from-data` apart. What they should give is not here."""

QUESTIONS = {
    "damping": [
        ([1.0, 2.0, 3.0], [0.5, 1.0, 1.5]),
        ([0.1, 1.0, 2.0], [0.4, 1.9, 4.2]),
        ([-1.0, 0.5, 3.0, 2.0], [-2.5, 1.0, 5.5, 4.4]),
    ],
}
