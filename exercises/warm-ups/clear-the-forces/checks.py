"""Checks of `clear-the-forces`."""

import pytest

from course.scoring import kit


@pytest.mark.task("final_speed")
@pytest.mark.points(1)
def test_constant_force(submission):
    """The speed under a constant force"""
    kit.expect_cases(
        submission,
        "final_speed",
        ("mass", "force", "h", "n"),
        [((2.0, 3.0, 0.1, 10), 1.5), ((2.0, -3.0, 0.1, 10), -1.5), ((0.5, 9.81, 0.01, 200), 39.24)],
        source=(
            "a constant force: speed is force times time over mass, whatever the step; the "
            "loop's rounding is far below nine digits"
        ),
        quantity="the speed",
        units="m/s",
        message="The speed after n steps is wrong.",
        help="Print the sum of the forces in every step: it should be the same each time.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {
    "final_speed": [
        (2.0, 3.0, 0.1, 10),
        (0.5, 9.81, 0.01, 7),
        (1.3, -2.0, 0.2, 1),
        (1.3, -2.0, 0.2, 2),
        (2.0, -3.0, 0.1, 10),
    ]
}
