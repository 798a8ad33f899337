"""Calls that tell wrong programs of `hold-it-up` apart. What they should give is not here."""

QUESTIONS = {
    "holding_torque": [
        (2.0, 1.0, 0.0, 9.81),
        (3.0, 0.4, 0.7, 9.81),
        (1.5, 0.8, -0.4, 1.62),
        (1.0, 1.0, 2.0, 9.81),
    ],
}
