"""Calls that tell wrong programs of `count-the-steps` apart. What they should give is not here."""

QUESTIONS = {
    "steps_in": [
        (0.3, 0.1),
        (0.7, 0.1),
        (2.1, 0.3),
        (0.29, 0.01),
        (2.0, 0.25),
        (0.57, 0.19),
    ],
}
