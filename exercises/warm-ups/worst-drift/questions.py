"""Calls that tell wrong programs of `worst-drift` apart. What they should give is not here."""

QUESTIONS = {
    "worst_drift": [
        ([2.0, 2.2, 1.7, 2.1],),
        ([-5.0, -4.0, -5.5, -5.0],),
        ([10.0, 10.0, 9.0, 8.5],),
        ([4.0, 5.0, 3.5],),
        ([1.0, 5.0, 1.0],),
        ([10.0, 11.0, 12.0, 9.0],),
    ],
}
