"""Calls that tell wrong programs of `push-a-wall` apart. What they should give is not here."""

QUESTIONS = {
    "felt_mass": [
        (3.0, 1.0, 2.0, 0.0),
        (3.0, 1.0, 2.0, 0.5),
        (3.0, 1.0, 0.4, 0.5),
        (0.5, 2.0, 1.5, -1.0),
        (1.0, 3.0, 0.7, 1.2),
    ],
}
