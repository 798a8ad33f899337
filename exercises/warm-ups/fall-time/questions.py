"""Calls that tell wrong programs of `fall-time` apart. What they should give is not here."""

QUESTIONS = {
    "fall_time": [
        (1.0, 9.81),
        (7.3, 9.81),
        (20.0, 1.62),
        (0.4, 3.7),
    ],
}
