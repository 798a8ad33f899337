"""Checks of `shadow-gap`."""

import pytest

from course.scoring import kit

SQUARE = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)]
FAR = [(2.5, -0.5), (3.5, -0.5), (3.5, 0.5), (2.5, 0.5)]
TURNED = [(0.95, 0.25), (1.65, 0.95), (0.95, 1.65), (0.25, 0.95)]
WEDGE = [(-2.0, 0.25), (0.25, 0.0), (-0.5, 1.0)]
LONG = [(-2.0, -1.0), (1.25, -1.0), (1.25, 1.0), (-2.0, 1.0)]
SLOPE = [(0.0, 0.0), (3.0, 0.0), (0.0, 1.0)]
BRICK = [(0.9, 0.0), (1.6, 0.0), (1.6, 1.0), (0.9, 1.0)]
TOUCHING = [(0.5, 0.0), (1.5, 0.0), (1.0, 1.0)]

APART = [
    ((SQUARE, FAR, (1.0, 0.0)), 2.0),
    ((FAR, SQUARE, (1.0, 0.0)), 2.0),
    ((SQUARE, FAR, (5.0, 0.0)), 2.0),
    ((SQUARE, FAR, (-0.5, 0.0)), 2.0),
    ((SQUARE, TURNED, (1.0, 1.0)), 0.141421356237),
]
OVERLAPPING = [
    ((SQUARE, FAR, (0.0, 1.0)), -1.0),
    ((SQUARE, TURNED, (1.0, 0.0)), -0.25),
    ((TURNED, SQUARE, (2.0, 0.0)), -0.25),
    ((SQUARE, WEDGE, (0.0, 3.0)), -0.5),
    ((SQUARE, WEDGE, (1.0, 0.0)), -0.75),
    ((FAR, SQUARE, (3.0, -4.0)), 0.4),
    ((SQUARE, LONG, (1.0, 0.0)), -1.75),
    ((SLOPE, BRICK, (1.0, 0.0)), -1.6),
    ((SQUARE, TOUCHING, (1.0, 0.0)), 0.0),
]


def expect_gaps(submission, cases):
    kit.expect_cases(
        submission,
        "shadow_gap",
        ("a", "b", "direction"),
        cases,
        abs=1e-12,
        quantity="the gap",
        units="m",
        message="The gap of the shadows is wrong.",
        help=(
            "Mark on the line where each shadow begins and ends. Which ends face each other? Where they"
            " overlap there are two ways out, and the shorter one counts."
        ),
    )


@pytest.mark.task("shadow_gap")
@pytest.mark.points(1)
def test_apart(submission):
    """Shadows that are apart, in either order and for directions of any length"""
    expect_gaps(submission, APART)


@pytest.mark.task("shadow_gap")
@pytest.mark.points(1)
def test_overlapping(submission):
    """Shadows that overlap, cover each other or just touch"""
    expect_gaps(submission, OVERLAPPING)


#: Calls that tell wrong programs apart.
QUESTIONS = {"shadow_gap": [args for args, _ in APART + OVERLAPPING]}
