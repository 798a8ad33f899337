"""Checks of `model-error`."""

import pytest

from course.scoring import kit

CASES = [
    ((12.0, 10.0, 0.3, 0.0, 0.4), [1.0, 3.0]),
    ((10.0, 12.0, 0.0, 0.5, 0.0), [-3.0, -1.0]),
    ((5.0, 5.1, 0.1, 0.2, 0.2), [-0.7, 0.5]),
    ((-2.0, 1.0, 2.0, 3.0, 6.0), [-17.0, 11.0]),
    ((0.8, 0.5, 0.01, 0.02, 0.03), [0.225166852265, 0.374833147735]),
]


@pytest.mark.task("model_error")
@pytest.mark.points(1)
def test_intervals(submission):
    """Models that give too much and too little, and each uncertainty in turn"""
    kit.expect_cases(
        submission,
        "model_error",
        ("simulated", "measured", "u_num", "u_input", "u_data"),
        CASES,
        expect=kit.expect_array,
        abs=1e-12,
        quantity="the pair of ends",
        message="That is not the interval.",
        help="Its middle is simulated - measured. It reaches twice the root of a sum to either side.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"model_error": [args for args, _ in CASES]}
