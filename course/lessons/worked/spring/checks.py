"""Checks of the worked example; exercises are checked the same way."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from course.scoring import kit

GIVEN = {"stretch": 0.1, "rate": 2.0, "h": 0.05, "n": 200}
ROUNDING = "only rounding is allowed"


def explicit(x, v, rate, h):
    return x + h * v, v - h * rate**2 * x


def moved(step, given):
    """States of a method, shape (2, n + 1)."""
    states = [(given["stretch"], 0.0)]
    for _ in range(given["n"]):
        states.append(step(*states[-1], given["rate"], given["h"]))
    return np.array(states).T


def asked(submission, given):
    """The student's positions and velocities, shape (2, n + 1)."""
    found = kit.as_tuple(submission.call("trajectory", *given.values()), ("x", "v"))
    return np.array([kit.as_vector(values, given["n"] + 1) for values in found])


def moving(way):
    """A step whose new position is ``way(at)``: ``at`` has x, v, v_next and h."""

    def step(x, v, rate, h):
        v_next = v - h * rate**2 * x
        return way(SimpleNamespace(x=x, v=v, v_next=v_next, h=h)), v_next

    return step


#: How the position may move instead: code, new position, what it looks like, what to change.
OTHERS = (
    (
        "EULER_IS_SEMI_IMPLICIT",
        lambda at: at.x + at.h * at.v_next,
        "These are exactly the steps of semi-implicit Euler: the velocity is already updated when the "
        "position is computed.",
        "Explicit Euler uses only the old state: move the position with the old v, not with v_next.",
    ),
    (
        "STEP_FORGOTTEN",
        lambda at: at.x + at.v,
        "The position moves by v, as if a step lasted a second.",
        "A step lasts h seconds: move the position by h * v.",
    ),
    (
        "STEP_FORGOTTEN",
        lambda at: at.x + at.v_next,
        "The position moves by v_next, as if a step lasted a second.",
        "A step lasts h seconds, and explicit Euler uses the old v: move the position by h * v.",
    ),
    (
        "POSITION_FORGOTTEN",
        lambda at: at.h * at.v,
        "The new position is only the way of one step: the old position is not in it.",
        "Add the way to the old position: x + h * v.",
    ),
    (
        "WRONG_WAY",
        lambda at: at.x - at.h * at.v,
        "The position moves against the velocity.",
        "Add h * v.",
    ),
    (
        "MEAN_VELOCITY",
        lambda at: at.x + at.h * (at.v + at.v_next) / 2,
        "The position moves with the mean of the old and the new velocity.",
        "That is more exact, but it is not explicit Euler: use the old v alone.",
    ),
    (
        "VELOCITY_FORGOTTEN",
        lambda at: at.x + at.h,
        "The position moves by h, whatever the velocity is.",
        "In h seconds it moves by h * v.",
    ),
    (
        "POSITION_STANDS",
        lambda at: at.x,
        "The position never changes: no step gives x a new value.",
        "Assign the new position to x.",
    ),
)


def which_method(submission):
    """The mistake in the line that moves the position: its very states, over 20 steps."""
    given = {**GIVEN, "n": 20}
    found = kit.attempt(lambda: asked(submission, given))
    if found is None:
        return None
    if np.all(found[0] == GIVEN["stretch"]):
        return kit.Diagnosis(OTHERS[-1][0], *OTHERS[-1][2:])
    for code, way, looks_like, advice in OTHERS:
        if np.allclose(found, moved(moving(way), given), rtol=1e-12, atol=1e-15):
            return kit.Diagnosis(code, looks_like, advice)
    return None


@pytest.mark.task("trajectory")
@pytest.mark.points(4)
def test_first_step(submission):
    """A mass at rest is still where it was after the first step"""
    given = {**GIVEN, "n": 1}
    kit.expect_array(
        asked(submission, given)[0],
        moved(explicit, given)[0],
        abs=1e-12,
        source=ROUNDING,
        quantity="x",
        units="m",
        input=given,
        message="The mass starts at rest, so its old velocity is zero, but the first step moves it.",
        help="Compute the new position from the state at the start of the step.",
        diagnose=lambda: which_method(submission),
    )


@pytest.mark.task("trajectory")
@pytest.mark.points(6)
@pytest.mark.requires("first_step")
def test_energy_grows(submission):
    """Each step multiplies the energy by 1 + (rate h)^2"""
    x, v = asked(submission, GIVEN)
    rate, h = GIVEN["rate"], GIVEN["h"]
    energy = 0.5 * v**2 + 0.5 * rate**2 * x**2
    kit.expect_array(
        energy / energy[0],
        (1.0 + (rate * h) ** 2) ** np.arange(GIVEN["n"] + 1),
        rel=1e-9,
        source="exact for explicit Euler on a spring; 200 roundings lose less than 1e-12",
        quantity="energy over its start",
        input=GIVEN,
        message="Each step of explicit Euler multiplies the energy by 1 + (rate h)^2. This one does not.",
        help="Compute the new position and the new velocity from the old ones.",
        diagnose=lambda: which_method(submission),
    )
