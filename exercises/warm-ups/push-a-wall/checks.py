"""Checks of `push-a-wall`."""

import pytest

from course.scoring import kit

CASES = [
    ((3.0, 1.0, 2.0, 0.0), 4.0),
    ((3.0, 1.0, 2.0, 1.5707963267948966), 1.0),
    ((3.0, 1.0, 2.0, 0.5), 2.58283010797),
    ((3.0, 1.0, 0.4, 0.5), 2.58283010797),
    ((0.5, 2.5, 1.5, -1.0), 2.83667681146),
]


@pytest.mark.task("felt_mass")
@pytest.mark.points(1)
def test_masses(submission):
    """The rod along the rail, upright, and between"""
    kit.expect_cases(
        submission,
        "felt_mass",
        ("carriage", "tip", "length", "angle"),
        CASES,
        quantity="the mass felt",
        units="kg",
        message="That is not the mass that the wall feels.",
        help="Work from the right: x with M x = Jᵀ, then J x, then one over it. The length must cancel.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"felt_mass": [args for args, _ in CASES]}
