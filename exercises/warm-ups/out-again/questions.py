"""Calls that tell wrong programs of `out-again` apart. What they should give is not here."""

QUESTIONS = {
    "push_out": [
        (0.01, 0.01, 0.2, 0.002),
        (0.05, 0.004, 0.1, 0.01),
        (0.001, 0.01, 0.2, 0.002),
        (-0.03, 0.01, 0.2, 0.002),
    ],
}
