"""Checks of `counts-of-a-sensor`."""

import pytest

from course.scoring import kit

WITHIN_REACH = [
    ((1.237, 0.01, 4.0), 1.24),
    ((1.233, 0.01, 4.0), 1.23),
    ((0.7, 0.25, 2.0), 0.75),
    ((2.6, 0.3333333, 7.0), 2.6666664),
]
BEYOND_REACH = [((7.3, 0.01, 4.0), 4.0), ((2.2, 0.25, 2.0), 2.0), ((0.31, 0.01, 0.29), 0.29)]


@pytest.mark.task("reading")
@pytest.mark.points(1)
def test_within(submission):
    """Distances within reach"""
    kit.expect_cases(
        submission,
        "reading",
        ("distance", "resolution", "limit"),
        WITHIN_REACH,
        quantity="the reading",
        units="m",
        message="A reading within reach is wrong.",
        help=(
            "How many counts is the distance, as a whole number? A reading is that many times the resolution."
        ),
    )


@pytest.mark.task("reading")
@pytest.mark.points(1)
def test_beyond(submission):
    """Distances beyond the limit"""
    names = ("distance", "resolution", "limit")
    kit.expect_true(
        submission.call("reading", 7.3, 0.01, 4.0) is not None,
        "You give None beyond reach.",
        expected=4.0,
        input=dict(zip(names, (7.3, 0.01, 4.0), strict=True)),
        help="Beyond reach the sensor reads the limit itself.",
    )
    kit.expect_cases(
        submission,
        "reading",
        names,
        BEYOND_REACH,
        quantity="the reading",
        units="m",
        message="A reading beyond reach is wrong.",
        help="Beyond reach the sensor reads the limit itself.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"reading": [args for args, _ in WITHIN_REACH + BEYOND_REACH]}
