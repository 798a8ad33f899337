"""Checks of `overlap-of-balls`."""

import pytest

from course.scoring import kit


@pytest.mark.task("overlap")
@pytest.mark.points(1)
def test_depths(submission):
    """Overlapping balls and balls apart"""
    cases = [
        (([0.0, 0.0], [0.3, 0.4], 0.4, 0.3), 0.2),
        (([1.0, -2.0], [4.0, 2.0], 1.5, 2.0), -1.5),
        (([0.2, 0.1], [0.2, 0.3], 0.5, 0.1), 0.4),
    ]
    for args, expected in cases:
        kit.expect_close(
            submission.call("overlap", *args),
            expected,
            rel=1e-9,
            source="closed form, written down to twelve digits: only rounding is allowed",
            quantity="depth",
            units="m",
            input=dict(zip(("p", "q", "r1", "r2"), args, strict=True)),
            message="The depth is wrong.",
            help="Draw the two balls on a line: three lengths have to be compared.",
        )


#: Calls that tell wrong programs apart.
QUESTIONS = {
    "overlap": [
        ([0.0, 0.0], [0.3, 0.4], 0.4, 0.3),
        ([1.0, -2.0], [4.0, 2.0], 1.5, 2.0),
        ([0.2, 0.1], [0.2, 0.3], 0.5, 0.1),
    ],
}
