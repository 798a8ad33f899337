"""Calls that tell wrong programs of `model-error` apart. What they should give is not here."""

QUESTIONS = {
    "model_error": [
        (12.0, 10.0, 0.3, 0.0, 0.4),
        (10.0, 12.0, 0.0, 0.5, 0.0),
        (5.0, 5.1, 0.1, 0.2, 0.2),
        (-2.0, 1.0, 2.0, 3.0, 6.0),
        (0.8, 0.5, 0.01, 0.02, 0.03),
    ],
}
