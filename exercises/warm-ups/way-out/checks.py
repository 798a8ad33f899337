"""Checks of `way-out`."""

import pytest

from course.scoring import kit

OVERLAPPING = [
    ((0.5, -0.75, 2.0, 1.0), [0.0, -0.25]),
    ((1.5, 0.25, 2.0, 1.0), [0.5, 0.0]),
    ((-1.75, 0.5, 2.0, 1.0), [-0.25, 0.0]),
    ((0.4567891, 0.75, 1.0, 3.0), [0.5432109, 0.0]),
    ((-0.25, 2.5, 1.0, 3.0), [0.0, 0.5]),
    ((-0.499, 0.998, 1.0, 1.0), [0.0, 0.002]),
    ((0.9, -0.3, 2.0, 1.0), [0.0, -0.7]),
    ((-0.2, 1.0, 1.0, 3.0), [-0.8, 0.0]),
]
APART = [
    ((3.0, 0.25, 2.0, 1.0), [0.0, 0.0]),
    ((0.5, -1.5, 2.0, 1.0), [0.0, 0.0]),
    ((2.0, 0.25, 2.0, 1.0), [0.0, 0.0]),
    ((0.25, -1.0, 2.0, 1.0), [0.0, 0.0]),
    ((-5.0, 5.0, 2.0, 1.0), [0.0, 0.0]),
]


def expect_moves(submission, cases, message, help):
    kit.expect_cases(
        submission,
        "way_out",
        ("x", "y", "width", "height"),
        cases,
        expect=kit.expect_array,
        abs=1e-12,
        quantity="the pair (dx, dy)",
        units="m",
        message=message,
        help=help,
    )


@pytest.mark.task("way_out")
@pytest.mark.points(1)
def test_overlapping(submission):
    """All four ways out, of long boxes and high ones"""
    expect_moves(
        submission,
        OVERLAPPING,
        "That is not the shortest move.",
        "How deep do they overlap along x, how deep along y? Move by the smaller depth, away from the first.",
    )


@pytest.mark.task("way_out")
@pytest.mark.points(1)
def test_apart(submission):
    """Boxes beside each other, above each other, and just touching"""
    expect_moves(
        submission,
        APART,
        "You move a box that overlaps nothing.",
        "They overlap only if they do so along x and along y.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"way_out": [args for args, _ in OVERLAPPING + APART]}
