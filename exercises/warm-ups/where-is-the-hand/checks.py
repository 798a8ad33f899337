"""Checks of `where-is-the-hand`."""

import pytest

from course.scoring import kit

CASES = [
    ((0.3, 0.5, 1.0, 0.7), [1.44303118567, 0.797669470291]),
    ((-0.8, 2.0, 0.4, 0.6), [0.496097336425, 0.272281015221]),
    ((1.2, -0.4, 0.5, 0.5), [0.529532231912, 0.824697588433]),
    ((2.8, 1.1, 1.0, 0.55), [-1.34148510798, -0.0432832373953]),
]


@pytest.mark.task("hand")
@pytest.mark.points(1)
def test_positions(submission):
    """Where bent arms reach"""
    kit.expect_cases(
        submission,
        "hand",
        ("a1", "a2", "l1", "l2"),
        CASES,
        expect=kit.expect_array,
        abs=1e-12,
        quantity="the pair of x and y of the hand",
        units="m",
        message="The position of the hand is wrong.",
        help="Draw the arm with a1 = 90 degrees and a2 = 0: where does the second link point?",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"hand": [args for args, _ in CASES]}
