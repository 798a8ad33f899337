"""Calls that tell wrong programs of `clear-the-forces` apart. What they should give is not here."""

QUESTIONS = {
    "final_speed": [
        (2.0, 3.0, 0.1, 10),
        (0.5, 9.81, 0.01, 7),
        (1.3, -2.0, 0.2, 1),
        (1.3, -2.0, 0.2, 2),
    ],
}
