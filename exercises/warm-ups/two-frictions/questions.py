"""Calls that tell wrong programs of `two-frictions` apart. What they should give is not here."""

QUESTIONS = {
    "pair_friction": [
        (0.9, 0.1, "product"),
        (0.9, 0.1, "mean"),
        (0.9, 0.1, "larger"),
        (0.2, 0.6, "larger"),
        (0.2, 0.6, "mean"),
        (1.2, 0.5, "product"),
    ],
}
