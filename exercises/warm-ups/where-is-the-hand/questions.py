"""Calls that tell wrong programs of `where-is-the-hand` apart. What they should give is not here."""

QUESTIONS = {
    "hand": [
        (0.3, 0.5, 1.0, 0.7),
        (-0.8, 2.0, 0.4, 0.6),
        (1.2, -0.4, 0.5, 0.55),
        (0.9, 0.0, 1.0, 1.0),
    ],
}
