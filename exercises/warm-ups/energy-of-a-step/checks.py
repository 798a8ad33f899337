"""Checks of `energy-of-a-step`."""

import pytest

from course.scoring import kit

CASES = [((4.0, 1.0, 0.05), 1.01), ((100.0, 2.5, 0.1), 1.4), ((0.3, 7.0, 1.0), 1.04285714286)]


@pytest.mark.task("growth")
@pytest.mark.points(1)
def test_factors(submission):
    """Soft and stiff springs, short and long steps"""
    kit.expect_cases(
        submission,
        "growth",
        ("k", "m", "h"),
        CASES,
        quantity="the energy factor of a step",
        message="The factor of one step is wrong.",
        help="Square x + h v and v - h (k/m) x, weight them as in the energy, and add.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"growth": [args for args, _ in CASES]}
