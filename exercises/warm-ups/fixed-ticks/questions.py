"""Calls that tell wrong programs of `fixed-ticks` apart. What they should give is not here."""

QUESTIONS = {
    "ticks": [
        (0.025, 0.01, 0.006),
        (0.004, 0.01, 0.003),
        (0.1, 0.007, 0.0045),
        (0.033, 0.02, 0.0195),
    ],
}
