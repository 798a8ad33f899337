"""Checks of `count-the-steps`."""

import pytest

from course.scoring import kit

CASES = [
    ((0.3, 0.1), 3),
    ((0.7, 0.1), 7),
    ((2.1, 0.3), 7),
    ((2.0, 0.01), 200),
    ((1.0, 0.1), 10),
    ((0.25, 0.25), 1),
    ((16.391, 0.001), 16391),
    ((16777.313, 0.001), 16777313),
]


@pytest.mark.task("steps_in")
@pytest.mark.points(1)
def test_quotients_beside_a_whole_number(submission):
    """Quotients just beside a whole number"""
    kit.expect_cases(
        submission,
        "steps_in",
        ("duration", "h"),
        CASES,
        expect=kit.expect_equal,
        message="The number of steps is wrong.",
        help="Print duration / h with repr(): how far is it from a whole number? Is your result an int?",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"steps_in": [args for args, _ in CASES]}
