"""Calls that tell wrong programs of `one-step-ahead` apart. What they should give is not here."""

QUESTIONS = {
    "step_ahead": [
        (0.0, 2.0, -9.81, 0.1),
        (1.5, -0.5, 3.0, 0.25),
        (10.0, 1.3, 0.7, 0.9),
    ],
}
