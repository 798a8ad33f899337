"""Calls that tell wrong programs of `same-floor` apart. What they should give is not here."""

QUESTIONS = {
    "same_floor": [
        (0.75, 0.0025, 0.01, 0.005),
        (0.4, 0.002, 0.004, 0.01),
        (0.2, 0.01, 0.001, 0.001),
    ],
}
