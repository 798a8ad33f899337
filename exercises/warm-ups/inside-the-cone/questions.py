"""Calls that tell wrong programs of `inside-the-cone` apart. What they should give is not here."""

QUESTIONS = {
    "friction": [
        ([0.3, -0.4], 2.0, 0.5),
        ([3.0, -4.0], 2.0, 0.5),
        ([0.5, 1.2], 1.0, 0.65),
        ([-1.0, 0.0], 3.0, 0.2),
        ([0.7, 0.7], 2.0, 0.45),
    ],
}
