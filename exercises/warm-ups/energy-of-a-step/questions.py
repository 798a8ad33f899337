"""Calls that tell wrong programs of `energy-of-a-step` apart. What they should give is not here."""

QUESTIONS = {
    "growth": [
        (4.0, 1.0, 0.05),
        (100.0, 2.5, 0.1),
        (0.3, 6.0, 1.0),
    ],
}
