"""Checks of `counts-of-a-sensor`."""

import pytest

from course.scoring import kit


@pytest.mark.task("reading")
@pytest.mark.points(1)
def test_within(submission):
    """Distances within reach go to the nearest count"""
    cases = [
        ((1.237, 0.01, 4.0), 1.24),
        ((1.233, 0.01, 4.0), 1.23),
        ((0.7, 0.25, 2.0), 0.75),
    ]
    for args, expected in cases:
        kit.expect_close(
            submission.call("reading", *args),
            expected,
            rel=1e-9,
            source="closed form, written down to twelve digits: only rounding is allowed",
            quantity="reading",
            units="m",
            input=dict(zip(("distance", "resolution", "limit"), args, strict=True)),
            message="A reading within reach is wrong.",
            help="How many counts is the distance, as a whole number?",
        )


@pytest.mark.task("reading")
@pytest.mark.points(1)
def test_beyond(submission):
    """Distances beyond the limit are read as the limit"""
    cases = [
        ((7.3, 0.01, 4.0), 4.0),
        ((2.2, 0.25, 2.0), 2.0),
    ]
    for args, expected in cases:
        kit.expect_close(
            submission.call("reading", *args),
            expected,
            rel=1e-9,
            source="closed form, written down to twelve digits: only rounding is allowed",
            quantity="reading",
            units="m",
            input=dict(zip(("distance", "resolution", "limit"), args, strict=True)),
            message="A reading beyond reach is wrong.",
            help="The reading never exceeds the limit.",
        )


#: Calls that tell wrong programs apart.
QUESTIONS = {
    "reading": [
        (1.237, 0.01, 4.0),
        (1.233, 0.01, 4.0),
        (0.7, 0.25, 2.0),
        (7.3, 0.01, 4.0),
        (2.2, 0.25, 2.0),
        (0.6, 0.25, 3.0),
        (2.6, 0.5, 7.0),
    ],
}
