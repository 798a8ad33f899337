"""Checks of `out-again`."""

import pytest

from course.scoring import kit

ASKED = {"abs": 1e-12, "quantity": "the separating speed", "units": "m/s"}
DEEP = [((0.017, 0.01, 0.2, 0.002), 0.3), ((0.05, 0.003, 0.1, 0.01), 1.33333333333)]
WITHIN_SLOP = [((0.001, 0.01, 0.2, 0.002), 0.0), ((-0.03, 0.01, 0.2, 0.002), 0.0)]


@pytest.mark.task("push_out")
@pytest.mark.points(1)
def test_deep(submission):
    """Bodies that are too deep"""
    kit.expect_cases(
        submission,
        "push_out",
        ("depth", "h", "beta", "slop"),
        DEEP,
        **ASKED,
        message="The speed that pushes out is wrong.",
        help=(
            "The share beta of the depth beyond the slop must go within a step. What distance is "
            "that, and in what time?"
        ),
    )


@pytest.mark.task("push_out")
@pytest.mark.points(1)
def test_within_slop(submission):
    """Bodies within the slop, or apart"""
    kit.expect_cases(
        submission,
        "push_out",
        ("depth", "h", "beta", "slop"),
        WITHIN_SLOP,
        **ASKED,
        message="Bodies that overlap by no more than the slop are moved.",
        help="Within the slop nothing is pushed: the speed is zero, neither positive nor negative.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"push_out": [args for args, _ in DEEP + WITHIN_SLOP]}
