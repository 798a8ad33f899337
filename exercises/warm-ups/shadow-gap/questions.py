"""Calls that tell wrong programs of `shadow-gap` apart. What they should give is not here."""

SQUARE = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)]
FAR = [(2.5, -0.5), (3.5, -0.5), (3.5, 0.5), (2.5, 0.5)]
TURNED = [(0.95, 0.25), (1.65, 0.95), (0.95, 1.65), (0.25, 0.95)]
WEDGE = [(-2.0, 0.25), (0.25, 0.0), (-0.5, 1.0)]
LONG = [(-2.0, -1.0), (1.25, -1.0), (1.25, 1.0), (-2.0, 1.0)]

QUESTIONS = {
    "shadow_gap": [
        (SQUARE, FAR, (1.0, 0.0)),
        (FAR, SQUARE, (1.0, 0.0)),
        (SQUARE, FAR, (5.0, 0.0)),
        (SQUARE, TURNED, (1.0, 1.0)),
        (SQUARE, FAR, (0.0, 1.0)),
        (SQUARE, TURNED, (1.0, 0.0)),
        (SQUARE, WEDGE, (0.0, 3.0)),
        (SQUARE, WEDGE, (1.0, 0.0)),
        (FAR, SQUARE, (3.0, -4.0)),
        (SQUARE, LONG, (1.0, 0.0)),
    ],
}
