"""Checks of `out-again`."""

import pytest

from course.scoring import kit


@pytest.mark.task("push_out")
@pytest.mark.points(1)
def test_deep(submission):
    """Bodies that are too deep"""
    kit.expect_cases(
        submission,
        "push_out",
        ("depth", "h", "beta", "slop"),
        [((0.017, 0.01, 0.2, 0.002), 0.3), ((0.05, 0.004, 0.1, 0.01), 1.0)],
        abs=1e-12,
        source="closed form; absolute 1e-12 m/s where it is zero",
        quantity="the separating speed",
        units="m/s",
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
        [((0.001, 0.01, 0.2, 0.002), 0.0), ((-0.03, 0.01, 0.2, 0.002), 0.0)],
        abs=1e-12,
        source="closed form; absolute 1e-12 m/s where it is zero",
        quantity="the separating speed",
        units="m/s",
        message="Bodies that overlap by no more than the slop are moved.",
        help="Within the slop nothing is pushed: the speed is zero, neither positive nor negative.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {
    "push_out": [
        (0.017, 0.01, 0.2, 0.002),
        (0.05, 0.004, 0.1, 0.01),
        (0.001, 0.01, 0.2, 0.002),
        (-0.03, 0.01, 0.2, 0.002),
    ]
}
