"""Calls that tell wrong programs of `friction-from-a-slide` apart. What they should give is not here."""

QUESTIONS = {
    "friction_coefficient": [
        (2.0, 0.5, 9.81),
        (1.5, 1.2, 9.81),
        (1.0, 0.8, 1.62),
    ],
}
