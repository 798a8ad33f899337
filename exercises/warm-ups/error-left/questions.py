"""Calls that tell wrong programs of `error-left` apart. What they should give is not here."""

QUESTIONS = {
    "error_left": [
        (10.4, 10.1, 2.0, 2.0),
        (10.4, 10.2, 2.0, 1.0),
        (-3.0, -2.68, 3.0, 2.0),
        (1.0, 1.255, 4.0, 4.0),
        (7.0, 6.0, 10.0, 1.5),
    ],
}
