"""Checks of `worst-drift`."""

import pytest

from course.scoring import kit

CASES = [
    (([2.0, 2.2, 1.7, 2.1],), 0.15),
    (([-5.0, -4.0, -5.5, -5.0],), 0.2),
    (([10.0, 10.0, 9.0, 8.5],), 0.15),
    (([1.0, 5.0, 1.5],), 4.0),
    (([3.0, -2.0, 3.1],), 1.66666666667),
]


@pytest.mark.task("worst_drift")
@pytest.mark.points(1)
def test_drifts(submission):
    """Energies that rise, fall, come back and are negative"""
    kit.expect_cases(
        submission,
        "worst_drift",
        ("energies",),
        CASES,
        quantity="the worst drift",
        message="The worst drift is wrong.",
        help="Which of the values is furthest from the first?",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"worst_drift": [args for args, _ in CASES]}
