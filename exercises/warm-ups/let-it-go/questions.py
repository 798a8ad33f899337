"""Calls that tell wrong programs of `let-it-go` apart. What they should give is not here."""

QUESTIONS = {
    "angular_acceleration": [
        (0.0, 2.0, 1.0, 0.0, 9.81),
        (12.0, 2.0, 1.0, 0.3, 9.81),
        (-1.0, 0.5, 0.6, -1.0, 1.62),
    ],
}
