"""Checks of `fixed-ticks`."""

import pytest

from course.scoring import kit

CASES = [
    ((0.025, 0.01, 0.006), [3, 0.001]),
    ((0.004, 0.01, 0.003), [0, 0.007]),
    ((0.1, 0.007, 0.0023457), [14, 0.0043457]),
    ((0.015625, 0.015625, 0.0), [1, 0.0]),  # exact in binary
]


@pytest.mark.task("ticks")
@pytest.mark.points(1)
def test_frames(submission):
    """Short and long frames: their steps, and the time left over"""
    kit.expect_cases(
        submission,
        "ticks",
        ("frame", "h", "left"),
        CASES,
        expect=kit.expect_array,
        abs=1e-12,
        quantity="the pair of steps and time left",
        message="The steps of a frame, or the time left over, are wrong.",
        help="What was left and the frame go into the account. As many steps as fit come out: less than one "
        "stays.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"ticks": [args for args, _ in CASES]}
