"""Checks of `robust-choice`."""

import pytest

from course.scoring import kit

CASES = [
    (([[1.0, 9.0, 1.0], [4.0, 5.0, 6.0], [0.0, 7.0, 8.0]],), 1),
    (([[3.0, 3.5], [1.0, 4.0], [3.6, 3.7]],), 0),
    (([[2.0, 8.0], [8.0, 1.0], [7.0, 7.5], [9.0, 0.0]],), 2),
    (([[5.0, 1.0], [2.0, 5.0]],), 0),
    (([[0.0, 1.0], [6.0, 8.0], [4.5, 3.0]],), 0),
    (([[5.0, 5.0], [5.0, 1.0]],), 0),
    (([[-1.0, -2.0], [-3.0, -4.0]],), 1),
    (([[500.0], [200.0]],), 1),
    (([[-5.0, -1.0], [-3.0, -2.0]],), 1),
    (([[0.0, 6.0, 0.0], [4.0, 3.0, 5.0], [7.0, 0.0, 0.0], [3.0, 3.0, 4.5]],), 3),
]


@pytest.mark.task("robust")
@pytest.mark.points(1)
def test_choices(submission):
    """Brilliant and steady controllers"""
    kit.expect_cases(
        submission,
        "robust",
        ("costs",),
        CASES,
        expect=kit.expect_equal,
        message="That is not the controller with the smallest worst cost.",
        help="Write the worst cost of each controller beside it.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"robust": [args for args, _ in CASES]}
