"""What the hidden graders of ``integrators`` share: problems drawn from a seed, and bundles of expectations.

Generic parameters matter. From rest at half a period semi-implicit Euler shows order 2; on a spring without
a clock RK4 with frozen stage times still shows order 4; on free fall position-first semi-implicit Euler
looks like explicit Euler.
"""

from __future__ import annotations

import math

import numpy as np

from course.physics import invariants, systems
from course.scoring import kit

probes = kit.companion("integrators", "probes")
cases = kit.companion("integrators", "cases")
formulas = kit.reference("integrators", "formulas")

EXPLICIT, SEMI, VERLET, RK4 = (
    "explicit_euler_step",
    "semi_implicit_euler_step",
    "velocity_verlet_step",
    "rk4_step",
)

# -- problems -------------------------------------------------------------------------------------------


def signed(rng, low, high, d=1):
    """Numbers of either sign, never near zero."""
    return rng.uniform(low, high, d) * rng.choice([-1.0, 1.0], d)


def _start(rng, rate, d=1):
    return {
        "q0": signed(rng, 0.5, 1.2, d).tolist(),
        "v0": (rate * signed(rng, 0.3, 0.9, d)).tolist(),
        "rate": rate,
        "span": rng.uniform(1.2, 1.9) / rate,
        "t0": rng.uniform(0.2, 2.0),
    }


def spring(rng):
    rate = rng.uniform(0.8, 4.0)
    return kit.Problem("a spring", systems.Oscillator(rate), **_start(rng, rate, 2))


def pendulum(rng):
    system = systems.Pendulum(9.81, rng.uniform(0.4, 2.0))
    return kit.Problem("a pendulum", system, **_start(rng, math.sqrt(system.g / system.length), 2))


def driven_spring(rng):
    rate = rng.uniform(0.8, 3.0)
    system = systems.ForcedOscillator(rate, rate**2 * rng.uniform(0.6, 1.4), rate * rng.uniform(1.3, 1.8))
    return kit.Problem("a driven spring", system, **_start(rng, rate))


def orbit(rng):
    mu, radius, eccentricity = rng.uniform(0.5, 3.0), rng.uniform(0.8, 1.5), rng.uniform(0.1, 0.3)
    angle = rng.uniform(0.0, 2 * math.pi)
    speed = math.sqrt(mu / radius * (1 + eccentricity) / (1 - eccentricity))
    across = np.array([math.cos(angle), math.sin(angle)])
    rate = math.sqrt(mu / radius**3)
    return kit.Problem(
        "an orbit in the plane",
        systems.Kepler(mu),
        q0=(radius * (1 - eccentricity) * across).tolist(),
        v0=(speed * np.array([-across[1], across[0]])).tolist(),
        rate=rate,
        span=rng.uniform(1.2, 1.9) / rate,
        t0=rng.uniform(0.2, 2.0),
    )


def damped_spring(rng):
    rate = rng.uniform(0.8, 3.0)
    system = systems.DampedOscillator(rate, rate * rng.uniform(0.2, 0.6))
    return kit.Problem("a damped spring", system, **_start(rng, rate, 2))


def van_der_pol(rng):
    # A stronger mu brings RK4's fourth- and fifth-order errors close enough to cancel at these steps.
    rate = rng.uniform(0.8, 2.0)
    system = systems.VanDerPol(rate * rng.uniform(0.2, 0.5), rate)
    return kit.Problem("a van der Pol oscillator", system, **_start(rng, rate))


CONSERVATIVE = (spring, pendulum, driven_spring, orbit)
EVERYTHING = (*CONSERVATIVE, damped_spring, van_der_pol)

# -- what several checks expect -------------------------------------------------------------------------

#: How many steps cover the span (1.2 to 1.9 rad): h * rate stays below 0.02 for the first-order methods, and
#: RK4's errors stay between 1e-10 and 1e-4.
COUNTS = {EXPLICIT: (96, 144, 216), SEMI: (96, 144, 216), VERLET: (24, 48, 96), RK4: (32, 48, 72)}
WITHIN = {EXPLICIT: 0.15, SEMI: 0.15, VERLET: 0.1, RK4: 0.3}


def expect_orders(submission, task, problems):
    """The step converges at its order on every problem."""
    measured = kit.march_all_errors(submission, task, problems, COUNTS[task])
    for problem, (hs, errors) in zip(problems, measured, strict=True):
        kit.expect_order(
            hs,
            errors,
            probes.ORDERS[task],
            abs=WITHIN[task],
            source="slopes of correct methods over many seeds, with a margin",
            input=problem.input,
            message=f"On {problem.name}, the error does not shrink with the step as it should.",
            help="Compare one step with the formula: time, position and velocity of each evaluation.",
            diagnose=lambda hs=hs, errors=errors, problem=problem: probes.of_order_measured(
                submission, task, hs, errors, problem.run(24)
            ),
        )


def unknown_system(rng):
    """A right-hand side that only the grader knows, counted, and a generic state to take a step from."""
    stiffness, drag, push, beat = rng.uniform(1.0, 4.0, 4)

    def accel(t, q, v):
        return -stiffness * np.sin(q) * (1 + 0.2 * q * q) - drag * v * abs(v) + push * np.cos(beat * t + q)

    q, v = signed(rng, 3.5, 9.0, 3), signed(rng, 0.4, 1.2, 3)  # beyond what an angle is
    return kit.acceleration(accel, 3), rng.uniform(0.3, 2.0), q, v, rng.uniform(0.1, 0.3)


def expect_evaluations(accel, allowed):
    kit.expect_evaluations(
        accel.count,
        allowed,
        message="A step does not take the number of evaluations of accel that this method needs.",
        diagnose=lambda: probes.of_evaluations(accel.count, allowed),
    )


def expect_one_evaluation(accel, submission, task):
    """One evaluation; where the formula itself is wrong, that is said first."""
    if accel.count != 1:
        kit.fail(
            "A step does not take one evaluation of accel.",
            help="Call accel once, keep what it returns, and return both new values.",
            expected=1,
            actual=accel.count,
            units="evaluations",
            diagnose=lambda: probes.of_step(submission, task) or probes.of_evaluations(accel.count, (1,)),
        )


def expect_formula(submission, task, result, accel, t, q, v, h):
    """The result of a step is one of the forms that the method has."""
    q_next, v_next = kit.as_pair(result, len(q))
    forms = [right(accel, t, q, v, h) for right in formulas.RIGHT[task]]
    q_true, v_true = min(forms, key=lambda form: abs(form[0] - q_next).max() + abs(form[1] - v_next).max())
    for actual, expected, name, units in ((q_next, q_true, "q_next", "m"), (v_next, v_true, "v_next", "m/s")):
        kit.expect_array(
            actual,
            expected,
            rel=1e-10,
            source="rounding",
            quantity=name,
            units=units,
            input={"t": t, "q": q, "v": v, "h": h},
            message="On a system where time, position and velocity all matter, one step is not what the "
            "formula gives.",
            help="Compare one step with the formula, term by term: the factors, what accel is given, and "
            "nothing besides.",
            diagnose=lambda: (
                probes.of_step(submission, task) or probes.of_halves(q_next, v_next, (q_true, v_true))
            ),
        )


def expect_clean(submission, task, rng):
    """What ``cases.expect_clean`` asks, on a driven pendulum."""
    system = systems.DrivenPendulum(*rng.uniform(1.0, 3.0, 4).tolist())
    t, h = rng.uniform(0.2, 2.0), rng.uniform(0.1, 0.3)
    cases.expect_clean(submission, task, system, t, (rng.integers(1, 5, 2), rng.integers(-4, 0, 2)), h)


def expect_symplectic(submission, task, rng):
    """The Jacobian of one step on an orbit keeps the symplectic form; RK4's would be off by 1e-4."""
    problem = orbit(rng)
    h = rng.uniform(0.5, 0.8) / problem.rate

    def flows(states):
        results = submission.call_each(task, [(problem.system, problem.t0, y[:2], y[2:], h) for y in states])
        return np.array([np.concatenate(kit.as_pair(result, 2)) for result in results])

    with np.errstate(all="ignore"):
        derivative = invariants.jacobian_of_many(flows, np.concatenate([problem.q0, problem.v0]))
        defect = invariants.symplecticity_defect(derivative)
    kit.expect_close(
        defect,
        0.0,
        abs=1e-6,
        source="finite differences leave 1e-8 or less",
        quantity="max |J^T Omega J - Omega|",
        input={**problem.input, "h": h},
        message="This method conserves the symplectic form in a step on an orbit; yours does not.",
        help="Compare one step with the formula: which values each line uses, old or new, and with which "
        "factors.",
        diagnose=lambda: probes.of_step(submission, task),
    )


def expect_free_fall(submission, task, rng):
    """Constant acceleration is followed exactly."""
    system, h, n = systems.FreeFall(rng.uniform(1.6, 25.0)), rng.uniform(0.05, 0.3), 12
    q0, v0 = signed(rng, 1.0, 5.0, 3), signed(rng, 1.0, 5.0, 3)
    t, q, v = submission.march(task, system, q0, v0, h, n)
    up = np.array([0.0, 0.0, -system.g])
    s = t[:, None]
    for actual, expected, name, units in (
        (q, q0 + s * v0 + s**2 / 2 * up, "q", "m"),
        (v, v0 + s * up, "v", "m/s"),
    ):
        kit.expect_array(
            actual,
            expected,
            rel=1e-12,
            source="exact: only rounding is allowed",
            quantity=name,
            units=units,
            t=t,
            input={"g": system.g, "h": h, "q0": q0, "v0": v0},
            message="This method follows the parabola of free fall exactly; yours does not.",
            help="With a constant acceleration a, one step must give q + h*v + h**2/2*a and v + h*a.",
            diagnose=lambda: probes.of_step(submission, task),
        )


def expect_slopes(submission, points):
    """observed_order is the least-squares slope of the logarithms, for each (hs, errors, message)."""
    values = submission.call_each("observed_order", [(hs, errors) for hs, errors, _ in points])
    for value, (hs, errors, message) in zip(values, points, strict=True):
        kit.expect_close(
            value,
            invariants.convergence_order(hs, errors),
            abs=1e-8,
            source="rounding: the least-squares slope is one number",
            quantity="order",
            input={"hs": hs, "errors": errors},
            message=message,
            help="It is the slope of log error over log h by least squares, of all points as they are.",
            diagnose=lambda value=value, hs=hs, errors=errors: probes.of_order(submission, value, hs, errors),
        )


def expect_limits(submission, maps):
    """max_stable_step is ``limit / omega`` to 1 %, for each (step, omega, limit, message)."""
    values = submission.call_each("max_stable_step", [(step, omega) for step, omega, _, _ in maps])
    for value, (step, omega, limit, message) in zip(values, maps, strict=True):
        given = {**step.params(), "omega": omega}
        cases.expect_limit(submission, value, (step, omega, limit), input=given, message=message)
