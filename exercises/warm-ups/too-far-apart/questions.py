"""Calls that tell wrong programs of `too-far-apart` apart. What they should give is not here."""

QUESTIONS = {
    "distance_in_doubts": [
        (1.2, 0.03, 1.25, 0.04),
        (5.0, 0.2, 4.0, 0.1),
        (0.0, 1.0, 2.6, 2.4),
    ],
}
