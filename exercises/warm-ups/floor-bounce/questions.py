"""Calls that tell wrong programs of `floor-bounce` apart. What they should give is not here."""

QUESTIONS = {
    "after_floor": [
        (-3.0, 0.8),
        (2.0, 0.8),
        (-0.25, 0.5),
        (0.0, 0.4),
        (0.5, 0.3),
        (-1.0, 1.0),
        (-1.3, 0.0),
    ],
}
