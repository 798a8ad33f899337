"""Checks of `two-frictions`."""

import pytest

from course.scoring import kit

CASES = [
    ((0.9, 0.1, "product"), 0.09),
    ((0.9, 0.1, "mean"), 0.5),
    ((0.9, 0.1, "larger"), 0.9),
    ((0.2, 0.6, "larger"), 0.6),
    ((1.2, 0.5, "product"), 0.6),
    ((0.2, 0.6, "mean"), 0.4),
    ((1.2, 0.9, "larger"), 1.2),
    ((1.23457, 0.98765, "product"), 1.2193230605),
]


@pytest.mark.task("pair_friction")
@pytest.mark.points(1)
def test_rules(submission):
    """The coefficient by each rule"""
    kit.expect_cases(
        submission,
        "pair_friction",
        ("mu1", "mu2", "rule"),
        CASES,
        quantity="the coefficient",
        message="The coefficient of a pair is wrong.",
        help="Apply exactly the rule that is given.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"pair_friction": [args for args, _ in CASES]}
