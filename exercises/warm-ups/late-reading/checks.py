"""Checks of `late-reading`."""

import pytest

from course.scoring import kit

CASES = [
    (([0.0, 1.0, 2.0, 3.0], [5.0, 6.0, 7.0, 8.0], 0.5, 2.75), 7.0),
    (([0.0, 1.0, 2.0, 3.0], [5.0, 6.0, 7.0, 8.0], 0.5, 2.5), 7.0),
    (([0.0, 1.0, 2.0, 3.0], [5.0, 6.0, 7.0, 8.0], 0.5, 2.25), 6.0),
    (([0.0, 1.0], [5.0, 6.0], 0.5, 0.25), None),
    (([0.0, 0.25, 0.5, 0.75], [1.0, 2.0, 3.0, 4.0], 0.5, 0.75), 2.0),
    (([0.0, 1.0, 2.0], [5.0, 6.0, 7.0], 0.5, 1.25), 5.0),
    (([0.0, 1.0], [6.0, 5.0], 0.5, 4.0), 5.0),
    (([0.0, 1.0, 2.0], [3.0, 0.0, -1.0], 0.25, 2.0), 0.0),
    (([0.0, 1.0, 5.0], [1.0, 2.0, 3.0], 0.5, 4.0), 2.0),
    (([0.0, 0.5, 0.625], [1.0, 2.0, 3.0], 0.25, 0.8), 2.0),
]


@pytest.mark.task("seen")
@pytest.mark.points(1)
def test_readings(submission):
    """Before the first arrival, between arrivals, exactly at one, and after the last"""
    kit.expect_cases(
        submission,
        "seen",
        ("times", "values", "latency", "now"),
        CASES,
        expect=kit.expect_equal,
        message="That is not the newest value that has arrived.",
        help="Write down when each value arrives, and draw a line at now.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"seen": [args for args, _ in CASES]}
