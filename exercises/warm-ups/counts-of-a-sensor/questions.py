"""Calls that tell wrong programs of `counts-of-a-sensor` apart. What they should give is not here."""

QUESTIONS = {
    "reading": [
        (1.237, 0.01, 4.0),
        (1.233, 0.01, 4.0),
        (0.7, 0.25, 2.0),
        (7.3, 0.01, 4.0),
        (2.2, 0.25, 2.0),
        (0.6, 0.25, 3.0),
        (2.6, 0.5, 7.0),
    ],
}
