"""Checks of `drag-from-data`."""

import pytest

from course.scoring import kit

CASES = [
    (([1.0, 2.0, 3.0], [0.5, 1.0, 1.5]), 0.5),
    (([0.1, 1.0, 2.0], [0.4, 1.9, 4.2]), 2.06387225549),
    (([-1.0, 0.5, 3.0, 2.0], [-2.5, 1.0, 4.3, 4.6]), 1.76140350877),
]


@pytest.mark.task("damping")
@pytest.mark.points(1)
def test_slopes(submission):
    """Points on a line, and points with noise"""
    kit.expect_cases(
        submission,
        "damping",
        ("speeds", "forces"),
        CASES,
        quantity="the damping",
        units="N s/m",
        message="The slope is wrong.",
        help="Write down the sum of (f - b v)^2, and ask where it is smallest in b.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"damping": [args for args, _ in CASES]}
