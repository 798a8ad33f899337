"""Checks of `one-number-for-a-path`."""

import pytest

from course.scoring import kit

CASES = [
    (([0.0, 1.0], [0.3, 0.4]), 0.474341649025),
    (([1.0, 2.0, 3.0], [1.1, 1.8, 3.2]), 0.173205080757),
    (([0.0, 0.0, 0.0, 0.0, 0.0], [1.0, -1.0, 2.0, -2.0, 0.5]), 1.43178210633),
]


@pytest.mark.task("rms")
@pytest.mark.points(1)
def test_paths(submission):
    """Paths of two, three and five points"""
    kit.expect_cases(
        submission,
        "rms",
        ("simulated", "measured"),
        CASES,
        quantity="the root mean square",
        units="m",
        message="The root mean square is wrong.",
        help="Go through its name backwards: square, mean, root. What is squared is each difference itself.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"rms": [args for args, _ in CASES]}
