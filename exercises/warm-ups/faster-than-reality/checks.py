"""Checks of `faster-than-reality`."""

import pytest

from course.scoring import kit


@pytest.mark.task("real_time_factor")
@pytest.mark.points(1)
def test_factors(submission):
    """Three runs have the right real-time factors"""
    cases = [
        ((1000, 0.001, 0.5), 2.0),
        ((24000, 0.0025, 3.0), 20.0),
        ((300, 0.01, 12.0), 0.25),
    ]
    for args, expected in cases:
        kit.expect_close(
            submission.call("real_time_factor", *args),
            expected,
            rel=1e-9,
            source="closed form, written down to twelve digits: only rounding is allowed",
            quantity="real-time factor",
            units="1",
            input=dict(zip(("steps", "h", "wall"), args, strict=True)),
            message="The real-time factor is wrong.",
            help="Work out first how much time passed inside the simulation.",
        )


#: Calls that tell wrong programs apart.
QUESTIONS = {
    "real_time_factor": [
        (1000, 0.001, 0.5),
        (24000, 0.0025, 3.1),
        (313, 0.013, 12.7),
    ],
}
