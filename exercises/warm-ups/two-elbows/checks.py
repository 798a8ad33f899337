"""Checks of `two-elbows`."""

import pytest

from course.scoring import kit

NAMES = ("x", "y", "length")
BOTH_PLACES = [
    ((10.0, 3.0, 5.0), [6.0, 14.0]),
    ((-2.0, 1.5, 2.5), [-4.0, 0.0]),
    ((0.7, -0.3, 0.5), [0.3, 1.1]),
    ((2.0, 1.0, 3.0), [-0.828427124746, 4.82842712475]),
    ((1.25, 2.0, 2.0), [1.25, 1.25]),
    ((0.5, -0.25, 0.25), [0.5, 0.5]),
]
OUT_OF_REACH = [
    ((0.0, 2.5, 2.0), False),
    ((4.0, -0.75, 0.5), False),
    ((1.0, 1.0, 0.9999), False),
    ((1.0, 1.0, 1.25), True),
]


@pytest.mark.task("carriages")
@pytest.mark.points(1)
def test_both_places(submission):
    """Points above and below the rail, and one that is just in reach"""
    for args, expected in BOTH_PLACES:
        found = submission.call("carriages", *args)
        given = dict(zip(NAMES, args, strict=True))
        kit.expect_true(
            found is not None,
            "You found no place, though the rod reaches the point.",
            expected="a pair",
            input=given,
            help=(
                "The rod reaches the point if it is at least as long as |y|, wherever along the rail"
                " that is. Return both places."
            ),
        )
        kit.expect_length(
            kit.as_list(found, "the pair of places"),
            2,
            name="the pair of places",
            input=given,
            message="You do not give two places.",
            help="Give a pair. Where the rod stands upright both places are the same: give it twice.",
        )
        kit.expect_array(
            found,
            expected,
            rel=1e-9,
            abs=1e-9,
            source="closed form, written down to twelve digits; absolute 1e-9 m where it is zero",
            quantity="the pair of places",
            units="m",
            input=given,
            message="The places of the carriage are wrong.",
            help="Check it backwards: from each of your places, is the point one rod length away?",
        )


@pytest.mark.task("carriages")
@pytest.mark.points(1)
def test_out_of_reach(submission):
    """Points too far above and too far below the rail, and one that is within reach"""
    for args, reached in OUT_OF_REACH:
        given = dict(zip(NAMES, args, strict=True))
        found = kit.expect_accepts(
            lambda args=args: submission.call("carriages", *args),
            "ValueError",
            message="Your code stops with a ValueError.",
            help="Only within reach there is a root, or an angle. Ask first whether |y| is above the length.",
            input=given,
        )
        kit.expect_true(
            (found is not None) == reached,
            "You found no place, though the rod reaches the point."
            if reached
            else "You do not give None, though the rod is too short to reach the point.",
            expected="a pair" if reached else None,
            actual=found,
            input=given,
            help="How far is the point from the rail, above or below? The rod must be as long as that.",
        )


#: Calls that tell wrong programs apart.
QUESTIONS = {"carriages": [args for args, _ in BOTH_PLACES + OUT_OF_REACH]}
