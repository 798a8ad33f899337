"""Calls that tell wrong programs of `push-never-pull` apart. What they should give is not here."""

QUESTIONS = {
    "applied": [
        (3.0, 2.0),
        (3.0, -1.0),
        (3.0, -5.0),
        (0.0, -2.0),
        (0.5, -0.25),
        (0.7, 0.4),
    ],
}
