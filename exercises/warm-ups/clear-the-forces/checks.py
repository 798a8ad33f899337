"""Checks of `clear-the-forces`."""

import pytest

from course.scoring import kit

CASES = [((2.0, 3.0, 0.1, 10), 1.5), ((2.0, -3.0, 0.1, 10), -1.5), ((0.7, 9.81, 0.01, 200), 28.0285714286)]


@pytest.mark.task("final_speed")
@pytest.mark.points(1)
def test_constant_force(submission):
    """The speed under a constant force"""
    kit.expect_cases(
        submission,
        "final_speed",
        ("mass", "force", "h", "n"),
        CASES,
        quantity="the speed",
        units="m/s",
        message="The speed after n steps is wrong.",
        help="Print the sum of the forces in every step: it should be the same each time.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"final_speed": [args for args, _ in CASES]}
