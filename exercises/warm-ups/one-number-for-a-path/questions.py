"""Calls that tell wrong programs of `one-number-for-a-path` apart. What they should give is not here."""

QUESTIONS = {
    "rms": [
        ([0.0, 1.0], [0.3, 0.6]),
        ([1.0, 2.0, 3.0], [1.1, 1.8, 3.2]),
        ([0.0, 0.0, 0.0, 0.0, 0.0], [1.0, -1.0, 2.0, -2.0, 0.5]),
    ],
}
