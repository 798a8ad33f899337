"""Calls that tell wrong programs of `which-line-first` apart. What they should give is not here."""

QUESTIONS = {
    "swing": [
        (1.0, 0.5, 4.0, 1.0, 0.05, 1),
        (1.0, 0.5, 4.0, 1.0, 0.05, 2),
        (0.3, -0.2, 9.0, 2.0, 0.1, 5),
    ],
}
