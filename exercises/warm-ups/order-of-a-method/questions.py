"""Calls that tell wrong programs of `order-of-a-method` apart. What they should give is not here."""

QUESTIONS = {
    "observed_order": [
        (0.1, 0.02, 0.05, 0.01),
        (0.1, 0.04, 0.05, 0.01),
        (0.1, 0.01, 0.025, 3.9e-05),
        (0.2, 0.3, 0.06, 0.05),
    ],
}
