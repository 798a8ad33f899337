"""Calls that tell wrong programs of `too-fast-to-see` apart. What they should give is not here."""

QUESTIONS = {
    "fastest": [
        (0.1, 0.05, 0.01),
        (0.02, 0.003, 0.004),
        (0.5, 0.0, 0.02),
        (0.0, 0.2, 0.1),
    ],
}
