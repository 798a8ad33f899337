"""Checks of `way-out`."""

import pytest

from course.scoring import kit


def moves(submission, cases, message, help_):
    for args, expected in cases:
        kit.expect_array(
            submission.call("way_out", *args),
            expected,
            rel=1e-9,
            abs=1e-12,
            source="closed form; absolute 1e-12 m where it is zero",
            quantity="the pair (dx, dy)",
            units="m",
            input=dict(zip(("x", "y", "width", "height"), args, strict=True)),
            message=message,
            help=help_,
        )


@pytest.mark.task("way_out")
@pytest.mark.points(1)
def test_overlapping(submission):
    """All four ways out, of long boxes and high ones"""
    moves(
        submission,
        [
            ((0.5, -0.75, 2.0, 1.0), [0.0, -0.25]),
            ((1.5, 0.25, 2.0, 1.0), [0.5, 0.0]),
            ((-1.75, 0.5, 2.0, 1.0), [-0.25, 0.0]),
            ((0.5, 0.75, 1.0, 3.0), [0.5, 0.0]),
            ((-0.25, 2.5, 1.0, 3.0), [0.0, 0.5]),
            ((-0.499, 0.998, 1.0, 1.0), [0.0, 0.002]),
            ((0.9, -0.3, 2.0, 1.0), [0.0, -0.7]),
            ((-0.2, 1.0, 1.0, 3.0), [-0.8, 0.0]),
        ],
        "That is not the shortest move.",
        "How deep do they overlap along x, how deep along y? Move by the smaller depth, away from the first.",
    )


@pytest.mark.task("way_out")
@pytest.mark.points(1)
def test_apart(submission):
    """Boxes beside each other, above each other, and just touching"""
    moves(
        submission,
        [
            ((3.0, 0.25, 2.0, 1.0), [0.0, 0.0]),
            ((0.5, -1.5, 2.0, 1.0), [0.0, 0.0]),
            ((2.0, 0.25, 2.0, 1.0), [0.0, 0.0]),
            ((0.25, -1.0, 2.0, 1.0), [0.0, 0.0]),
            ((-5.0, 5.0, 2.0, 1.0), [0.0, 0.0]),
        ],
        "You move a box that overlaps nothing.",
        "They overlap only if they do so along x and along y.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {
    "way_out": [
        (0.5, -0.75, 2.0, 1.0),
        (1.5, 0.25, 2.0, 1.0),
        (-1.75, 0.5, 2.0, 1.0),
        (0.5, 0.75, 1.0, 3.0),
        (-0.25, 2.5, 1.0, 3.0),
        (-0.499, 0.998, 1.0, 1.0),
        (0.9, -0.3, 2.0, 1.0),
        (-0.2, 1.0, 1.0, 3.0),
        (3.0, 0.25, 2.0, 1.0),
        (0.5, -1.5, 2.0, 1.0),
        (-5.0, 5.0, 2.0, 1.0),
    ]
}
