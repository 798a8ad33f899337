"""Calls that tell wrong programs of `share-the-error` apart. What they should give is not here."""

QUESTIONS = {
    "corrected": [
        (1.0, 1.4, 0.25),
        (2.0, 1.0, 0.9),
        (-0.5, 0.7, 1.0),
        (3.0, 8.0, 0.1),
    ],
}
