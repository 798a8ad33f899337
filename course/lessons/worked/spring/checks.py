"""Checks of the worked example; exercises are checked the same way."""

from __future__ import annotations

import numpy as np
import pytest

from course.scoring import kit

GIVEN = {"stretch": 0.1, "rate": 2.0, "h": 0.05, "n": 200}
ROUNDING = "only rounding is allowed"


def explicit(x, v, rate, h):
    return x + h * v, v - h * rate**2 * x


def semi_implicit(x, v, rate, h):
    v_next = v - h * rate**2 * x
    return x + h * v_next, v_next


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


def which_method(submission):
    """Semi-implicit Euler under the other's name: its very states, over 20 steps. Or no method at all."""
    given = {**GIVEN, "n": 20}
    found = kit.attempt(lambda: asked(submission, given))
    if found is not None and np.all(found[0] == GIVEN["stretch"]):
        return kit.Diagnosis(
            "POSITION_STANDS",
            "The position never changes: no step gives x a new value.",
            "Assign the new position to x.",
        )
    if found is not None and np.allclose(found, moved(semi_implicit, given), rtol=1e-12, atol=1e-15):
        return kit.Diagnosis(
            "EULER_IS_SEMI_IMPLICIT",
            "These are exactly the steps of semi-implicit Euler: the velocity is already updated when the "
            "position is computed.",
            "Explicit Euler uses only the old state: move the position with the old v, not with v_next.",
        )
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
        message="The mass starts at rest, so its old velocity is zero, and yet the first step moves it.",
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
        message="On a spring explicit Euler gains energy at every step, by one factor. This motion does not.",
        help="Compute the new position and the new velocity from the old ones.",
        diagnose=lambda: which_method(submission),
    )
