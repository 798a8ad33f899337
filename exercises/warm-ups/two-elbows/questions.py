"""Calls that tell wrong programs of `two-elbows` apart. What they should give is not here."""

QUESTIONS = {
    "carriages": [
        (10.0, 3.0, 5.0),
        (-2.0, 1.5, 2.5),
        (0.7, -0.3, 0.5),
        (2.0, 1.0, 3.0),
        (1.25, 2.0, 2.0),
        (0.5, -0.25, 0.25),
        (0.0, 2.5, 2.0),
        (4.0, -0.75, 0.5),
    ],
}
