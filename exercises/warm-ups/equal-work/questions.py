"""Calls that tell wrong programs of `equal-work` apart. What they should give is not here."""

QUESTIONS = {
    "fair_step": [
        (0.01, 50, 10),
        (0.002, 8, 20),
        (0.005, 30, 7),
    ],
}
