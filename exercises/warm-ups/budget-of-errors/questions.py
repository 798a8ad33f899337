"""Calls that tell wrong programs of `budget-of-errors` apart. What they should give is not here."""

QUESTIONS = {
    "total_error": [
        ([3.0, 4.0],),
        ([0.2, 0.5, 0.1],),
        ([1.0, 1.0, 1.0, 1.0],),
    ],
}
