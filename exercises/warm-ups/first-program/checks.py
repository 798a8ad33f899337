"""Checks of `first-program`: one for each fault."""

import math

import pytest

from course.scoring import kit

ROUNDING = "closed form: only rounding is allowed"

FIRST, SECOND = [[0.0, 1.0], [1.5, 1.25]], [[5.0, -2.0], [3.0, -2.5]]
GAPS = [
    ((FIRST, SECOND, 0), 5.0),
    ((FIRST, SECOND, 1), 1.5),
    ((SECOND, FIRST, 0), 5.0),
    (([[-5.0, 2.0], [-3.0, 2.0]], [[5.0, -2.0], [4.0, -2.0]], 1), 7.0),
]
LANDINGS = [
    ([0.5, 0.2, -0.2, -0.7, -1.3], 0.02),
    ([1.0, 0.6, 0.0, -0.9], 0.02),
    ([0.4, -0.1, 0.3, 0.1], 0.01),
    ([0.0, -0.1, -0.3], 0.0),
    ([0.5, 0.004, -0.3], 0.02),
]
CONTACTS = [((2.0, -2.0), [-2.0, 2.0]), ((3.0, 1.0), [1.0, 3.0]), ((0.5, -1.5), [-1.5, 0.5])]


@pytest.mark.task("gap")
@pytest.mark.points(1)
def test_gap_is_a_number(submission):
    """The distance between two balls at one sample"""
    for (one, other, k), expected in GAPS:
        kit.expect_close(
            kit.expect_accepts(
                lambda one=one, other=other, k=k: submission.call("gap", one, other, k),
                "TypeError",
                input={"first": one, "second": other, "k": k},
                message="The program stops here, with a TypeError.",
                help="Read the last line of the error, and then the line it points at.",
            ),
            expected,
            rel=1e-9,
            source=ROUNDING,
            quantity="the gap",
            units="m",
            input={"first": one, "second": other, "k": k},
            message="The distance of two balls is wrong.",
            help="A run is a list of pairs (position, velocity); take the two positions at sample k.",
        )


@pytest.mark.task("run")
@pytest.mark.points(1)
def test_run_begins_at_the_start(submission):
    """The samples of a run of three steps"""
    states = kit.as_list(submission.call("run", 10.0, 2.0, -9.81, 3), "the run")
    kit.expect_array(
        states[0] if states else [],
        [10.0, 2.0],
        rel=1e-9,
        source="the first sample is what was given",
        quantity="the first pair of position and velocity",
        input={"x": 10.0, "v": 2.0, "a": -9.81, "n": 3},
        message="The first sample of a run is not its start.",
        help="What is in the list before the first step has been taken?",
    )
    kit.expect_length(
        states,
        4,
        name="the run",
        input={"x": 10.0, "v": 2.0, "a": -9.81, "n": 3},
        message="A run of three steps does not have four samples.",
        help="Count the start, and the state after each step.",
    )
    x, v, a, n, h = 10.0, 2.0, -9.81, 100, 0.01
    states = kit.as_list(submission.call("run", x, v, a, n), "the run")
    kit.expect_array(
        states[-1] if states else [],
        [x + v * n * h + a * (n * h) ** 2 / 2, v + a * n * h],
        abs=abs(a) * n * h**2,
        source="a method of first order is off by a t h / 2",
        quantity="the pair of position and velocity after a second",
        input={"x": x, "v": v, "a": a, "n": n},
        message="The steps were right in the program as it was given. Now they are not.",
        help="Only what is in the list at the beginning is missing.",
    )


@pytest.mark.task("landing_time")
@pytest.mark.points(1)
def test_landing_is_where_the_ground_is(submission):
    """Where a fall ends"""
    for heights, expected in LANDINGS:
        found = submission.call("landing_time", heights)
        kit.expect_true(
            found is not None or heights[0] > 0.0,
            "You give None where the first sample is on the ground.",
            expected=expected,
            input={"heights": heights},
            help="The first sample has k = 0, which Python takes for false: ask for the height, not for k.",
        )
        kit.expect_close(
            found,
            expected,
            rel=1e-9,
            abs=1e-12,
            source=ROUNDING,
            quantity="the time of the landing",
            units="s",
            input={"heights": heights},
            message="The fall does not end at the ground.",
            help="Which sample is the first whose height is 0 or less?",
        )
    kit.expect_equal(
        submission.call("landing_time", [2.0, 1.5]),
        None,
        message="A ball that has not reached the ground has a landing time.",
        help="Give None where no sample is at or below the ground.",
        input={"heights": [2.0, 1.5]},
    )


@pytest.mark.task("after_contact")
@pytest.mark.points(1)
def test_balls_bounce(submission):
    """Equal balls that meet head-on"""
    for before, after in CONTACTS:
        kit.expect_array(
            submission.call("after_contact", *before),
            after,
            rel=1e-9,
            source="momentum and energy are both kept; masses are equal",
            quantity="the pair of velocities afterwards",
            units="m/s",
            input={"v1": before[0], "v2": before[1]},
            message="The two balls do not collide as equal elastic balls do.",
            help="Momentum and energy stay as they were. Which two velocities do that, beside the old ones?",
        )


@pytest.mark.task("euler_step")
@pytest.mark.points(1)
def test_euler_uses_old_rates(submission):
    """Explicit Euler: which velocity moves the ball"""
    x, v, a, h = 1.0, 0.5, -4.0, 0.1
    kit.expect_array(
        submission.call("euler_step", x, v, a, h),
        [x + h * v, v + h * a],
        rel=1e-9,
        source=ROUNDING,
        quantity="the pair of position and velocity",
        input={"x": x, "v": v, "a": a, "h": h},
        message="This is not a step of explicit Euler.",
        help="Both values move with their old rates, and both new ones are returned.",
    )


@pytest.mark.task("error_at_end")
@pytest.mark.points(1)
def test_error_is_taken_at_one_moment(submission):
    """The errors of exact positions, and of wrong ones"""
    for omega, n in ((2.0, 50), (3.0, 7)):
        exact = [math.cos(omega * 0.01 * k) for k in range(n + 1)]
        kit.expect_close(
            submission.call("error_at_end", exact, omega),
            0.0,
            abs=1e-12,
            source="the positions are exact: rounding of a cosine, some 1e-16",
            quantity="the error",
            units="m",
            input={"omega": omega, "samples": n + 1},
            message="Exact positions get an error that is not zero.",
            help=f"The first of the {n + 1} positions belongs to t = 0. To which time does the last belong?",
        )
    for positions, expected in (
        ([1.0, math.cos(0.02) + 0.25], 0.25),
        ([0.5, -1.0, -0.25], math.cos(0.04) + 0.25),
    ):
        kit.expect_close(
            submission.call("error_at_end", positions, 2.0),
            expected,
            rel=1e-9,
            source=ROUNDING,
            quantity="the error",
            units="m",
            input={"positions": positions, "omega": 2.0},
            message="The error of positions that are not exact is wrong.",
            help="Take the size of the difference between the last position and cos(omega t).",
        )


#: Calls that tell wrong programs apart.
QUESTIONS = {
    "gap": [args for args, _ in GAPS],
    "run": [(10.0, 2.0, -9.81, 3), (0.5, -1.0, 4.0, 1), (0.5, -1.0, 4.0, 0)],
    "landing_time": [([2.0, 1.5],), *((heights,) for heights, _ in LANDINGS)],
    "after_contact": [velocities for velocities, _ in CONTACTS],
    "euler_step": [(1.0, 0.5, -4.0, 0.1), (0.3, -2.0, 1.0, 0.5)],
    "error_at_end": [
        ([1.0, 0.9, 0.7], 2.0),
        ([1.0, 0.5], 3.0),
        ([1.0, 1.2, 1.0, 1.1, 1.5], 20.0),
        ([0.5, -1.0, -0.25], 2.0),
    ],
}
