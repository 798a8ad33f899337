"""Checks of the worked example; exercises are checked the same way."""

from __future__ import annotations

import numpy as np
import pytest

from course.grading import kit

ROUNDING = "exact for constant acceleration: only rounding is allowed"


@pytest.mark.task("fall_time")
@pytest.mark.points(2)
def test_fall_time_value(submission):
    """A fall from 10 m on Earth takes 1.428 s"""
    kit.expect_close(
        submission.call("fall_time", 10.0, 9.81),
        float(np.sqrt(2 * 10.0 / 9.81)),
        rel=1e-12,
        source=ROUNDING,
        quantity="fall time",
        units="s",
        input={"height": 10.0, "g": 9.81},
        message="The time to the ground is not the one that the distance fallen, g t**2 / 2, gives.",
        help="Set the distance fallen equal to the height and solve for t.",
    )


@pytest.mark.task("fall_time")
@pytest.mark.points(1)
@pytest.mark.requires("fall_time_value")
def test_fall_time_grows_with_the_root(submission):
    """Four times the height takes twice the time, on the Moon too"""
    low, high = (kit.as_number(submission.call("fall_time", z, 1.62), "fall time") for z in (3.0, 12.0))
    kit.expect_close(
        high / low,
        2.0,
        rel=1e-12,
        source=ROUNDING,
        quantity="ratio of the two times",
        input={"heights": [3.0, 12.0], "g": 1.62},
        message="The time does not grow with the square root of the height.",
        help="Look at where height stands in your formula, and at g.",
    )


@pytest.mark.task("fall_time")
@pytest.mark.points(1)
def test_fall_time_refuses_nonsense(submission):
    """A height below the ground is refused"""
    kit.expect_raises(
        lambda: submission.call("fall_time", -1.0, 9.81),
        "ValueError",
        message="A negative height has no fall time, and yours answers with one.",
        help="Raise ValueError for a negative height.",
        input={"height": -1.0, "g": 9.81},
    )


@pytest.mark.task("drop")
@pytest.mark.points(2)
def test_drop_samples(submission):
    """n steps give n + 1 samples, the first of them at t = 0"""
    t, z, v = kit.as_tuple(submission.call("drop", 5.0, 9.81, 0.25, 4), ("t", "z", "v"))
    for name, values in (("t", t), ("z", z), ("v", v)):
        kit.expect_length(
            values,
            5,
            name=name,
            input={"height": 5.0, "g": 9.81, "h": 0.25, "n": 4},
            message="There is not one sample for each moment: n steps have n + 1 ends.",
            help="Store the start before the first step.",
        )
    kit.expect_array(
        t,
        [0.0, 0.25, 0.5, 0.75, 1.0],
        abs=1e-12,
        source=ROUNDING,
        quantity="t",
        units="s",
        message="The times are not i h, beginning with 0.",
        help="Multiply the number of the step by h.",
    )


@pytest.mark.task("drop")
@pytest.mark.points(4)
@pytest.mark.requires("drop_samples")
def test_drop_follows_the_parabola(submission):
    """Height and velocity follow the closed form, whatever the step"""
    height, g, n = 20.0, 9.81, 50
    for h in (0.01, 0.04):
        t = h * np.arange(n + 1)
        _, z, v = kit.as_tuple(submission.call("drop", height, g, h, n), ("t", "z", "v"))
        for name, unit, actual, expected in (("z", "m", z, height - g * t**2 / 2), ("v", "m/s", v, -g * t)):
            kit.expect_array(
                actual,
                expected,
                # 50 additions of numbers near 20 lose 50 * 20 * 1e-16 = 1e-13 at the very most.
                abs=1e-12,
                source=ROUNDING,
                quantity=name,
                units=unit,
                t=t,
                input={"height": height, "g": g, "h": h, "n": n},
                message="The ball leaves the parabola it falls along.",
                help="Over a step the mean velocity lies halfway between the old and the new one.",
            )
