"""Calls that tell wrong programs of `robust-choice` apart. What they should give is not here."""

QUESTIONS = {
    "robust": [
        ([[1.0, 9.0, 1.0], [4.0, 5.0, 6.0], [0.0, 7.0, 8.0]],),
        ([[3.0, 3.5], [1.0, 4.0], [3.6, 3.7]],),
        ([[2.0, 8.0], [8.0, 1.0], [7.0, 7.5], [9.0, 0.0]],),
        ([[5.0, 1.0], [2.0, 5.0]],),
    ],
}
