"""Calls that tell wrong programs of `how-sure` apart. What they should give is not here."""

QUESTIONS = {
    "standard_error": [
        ([1.0, 3.0],),
        ([2.0, 4.0, 4.0, 6.0],),
        ([9.8, 9.9, 9.7, 9.8, 10.1, 9.6, 9.8, 9.9, 9.7],),
    ],
}
