"""Hidden graders of ``integrators``. Parameters are drawn anew from the seed of each grading run.

Thresholds come from sweeps over seeds and steps of every accepted solution; the table is in
``tests/benchmarks/calibration/integrators.md``.
"""

from __future__ import annotations

import math
from itertools import cycle

import numpy as np
import pytest

from course.physics import invariants, systems
from course.scoring import kit

probes = kit.companion("integrators", "probes")
bundles = kit.sibling(__file__, "bundles")
loops = kit.sibling(__file__, "loops")
EXPLICIT, SEMI, VERLET, RK4 = bundles.EXPLICIT, bundles.SEMI, bundles.VERLET, bundles.RK4

# -- explicit Euler -------------------------------------------------------------------------------------


@pytest.mark.task(EXPLICIT)
@pytest.mark.points(3)
def test_explicit_euler_order(submission, rng):
    """Explicit Euler's order on six different problems"""
    bundles.expect_orders(submission, EXPLICIT, [make(rng) for make in bundles.EVERYTHING])


@pytest.mark.task(EXPLICIT)
@pytest.mark.points(2)
def test_explicit_euler_one_step(submission, rng):
    """One step of explicit Euler on an unknown system, and its evaluations"""
    accel, t, q, v, h = bundles.unknown_system(rng)
    result = accel.during(lambda: submission.call(EXPLICIT, accel, t, q, v, h))
    bundles.expect_one_evaluation(accel, submission, EXPLICIT)
    bundles.expect_formula(submission, EXPLICIT, result, accel, t, q, v, h)


@pytest.mark.task(EXPLICIT)
@pytest.mark.points(2)
def test_explicit_euler_inputs(submission, rng):
    """Explicit Euler: its arguments, zeros, whole numbers, places far away"""
    bundles.expect_clean(submission, EXPLICIT, rng)


# -- semi-implicit Euler --------------------------------------------------------------------------------


@pytest.mark.task(SEMI)
@pytest.mark.points(4)
def test_semi_implicit_order(submission, rng):
    """Semi-implicit Euler's order on four different problems"""
    bundles.expect_orders(submission, SEMI, [make(rng) for make in bundles.CONSERVATIVE])


@pytest.mark.task(SEMI)
@pytest.mark.points(2)
@pytest.mark.requires("semi_implicit_energy")  # a step that ignores accel passes this one as well
def test_semi_implicit_symplectic(submission, rng):
    """Areas under semi-implicit Euler, on an orbit, at a large step"""
    bundles.expect_symplectic(submission, SEMI, rng)


@pytest.mark.task(SEMI)
@pytest.mark.points(2)
def test_semi_implicit_one_step(submission, rng):
    """One step of semi-implicit Euler on an unknown system, and its evaluations"""
    accel, t, q, v, h = bundles.unknown_system(rng)
    result = accel.during(lambda: submission.call(SEMI, accel, t, q, v, h))
    bundles.expect_one_evaluation(accel, submission, SEMI)
    bundles.expect_formula(submission, SEMI, result, accel, t, q, v, h)


@pytest.mark.task(SEMI)
@pytest.mark.points(2)
def test_semi_implicit_inputs(submission, rng):
    """Semi-implicit Euler: its arguments, zeros, whole numbers, places far away"""
    bundles.expect_clean(submission, SEMI, rng)


# -- velocity Verlet ------------------------------------------------------------------------------------


@pytest.mark.task(VERLET)
@pytest.mark.points(3)
def test_verlet_order_everywhere(submission, rng):
    """Velocity Verlet's order on four different problems"""
    bundles.expect_orders(submission, VERLET, [make(rng) for make in bundles.CONSERVATIVE])


@pytest.mark.task(VERLET)
@pytest.mark.points(2)
def test_verlet_energy(submission, rng):
    """How far velocity Verlet's energy on a spring swings"""
    # A turn takes k + 0.38 steps: near the golden ratio the samples never repeat, so some fall near q = 0.
    z = 2 * math.sin(math.pi / (rng.integers(9, 16) + rng.uniform(0.37, 0.39)))
    omega, n = rng.uniform(0.5, 5.0), 300
    system = systems.Oscillator(omega)
    q0 = bundles.signed(rng, 4.0, 8.0).tolist()  # beyond pi: a length is no angle
    _, q, v = submission.march(VERLET, system, q0, [0.0], z / omega, n)
    with np.errstate(all="ignore"):
        swing = float(np.max(np.abs(invariants.relative_change(invariants.energy(system, q, v)))))
    kick_first = z**2 / 4
    drift_first = kick_first / (1 - kick_first)
    nearest = min(kick_first, drift_first, key=lambda expected: abs(swing - expected))
    kit.expect_close(
        swing,
        nearest,
        rel=0.01,
        source="closed forms z^2/4 (kick-drift-kick) and z^2/4/(1 - z^2/4) (drift-kick-drift)",
        quantity="max |dE|/E0",
        input={"omega": omega, "h": z / omega, "q0": q0, "steps": n},
        message="Over many periods of a spring, the energy swings by another amount than under velocity "
        "Verlet.",
        help="There are two half kicks around one drift, each with the acceleration at its own end of the "
        "step, or two half drifts around one kick.",
        diagnose=lambda: probes.of_swing(
            submission, VERLET, swing, nearest, (system, q0, [0.0], z / omega, n, 0.0)
        ),
    )


@pytest.mark.task(VERLET)
@pytest.mark.points(1)
def test_verlet_frequency(submission, rng):
    """How fast velocity Verlet oscillates on a spring"""
    omega, z, n = rng.uniform(0.5, 5.0), rng.uniform(0.4, 1.2), 60
    h = z / omega
    start = bundles.signed(rng, 0.5, 1.5), omega * bundles.signed(rng, 0.3, 1.0)
    _, q, _ = submission.march(VERLET, systems.Oscillator(omega), *start, h, n)
    x = q[:, 0]
    with np.errstate(all="ignore"):
        # Samples of a turning pointer obey x[k+1] + x[k-1] = 2 cos(angle) x[k].
        cosine = float(x[1:-1] @ (x[2:] + x[:-2]) / (2 * x[1:-1] @ x[1:-1]))
    # A pointer that does not turn has a frequency, too: none, or half a turn a step.
    if np.all(np.isfinite(x)):
        cosine = min(max(cosine, -1.0), 1.0) if math.isfinite(cosine) else 1.0
    kit.expect_close(
        math.acos(cosine) / h if math.isfinite(cosine) else math.nan,
        2 / h * math.asin(z / 2),
        rel=1e-6,
        source="exact on a linear spring: only rounding is allowed",
        quantity="angular frequency, from x[k+1] + x[k-1] over x[k]",
        units="rad/s",
        input={"omega": omega, "h": h},
        message="On a spring, three positions in a row are not those of velocity Verlet.",
        help="Compare one step with the formula: the factors, and which acceleration each line gets.",
        diagnose=lambda: probes.of_step(submission, VERLET),
    )


@pytest.mark.task(VERLET)
@pytest.mark.points(1)
@pytest.mark.requires("verlet_order")  # a step that ignores accel passes this one as well
def test_verlet_symplectic(submission, rng):
    """Areas under velocity Verlet, on an orbit, at a large step"""
    bundles.expect_symplectic(submission, VERLET, rng)


@pytest.mark.task(VERLET)
@pytest.mark.points(1)
@pytest.mark.requires("verlet_order")  # a step that ignores accel passes this one as well
def test_verlet_reversible(submission, rng):
    """Velocity Verlet run forwards, reversed, and run back"""
    problem, n = bundles.pendulum(rng), 60
    h = rng.uniform(0.3, 0.5) / problem.rate
    _, q, v = submission.march(VERLET, problem.system, problem.q0, problem.v0, h, n)
    with np.errstate(all="ignore"):
        _, back, _ = submission.march(VERLET, problem.system, q[-1], -v[-1], h, n)
    kit.expect_array(
        back[-1],
        problem.q0,
        abs=1e-8,
        source="exactly reversible: only rounding, grown over the way there and back",
        quantity="q",
        units="rad",
        input={**problem.input, "h": h, "steps": n},
        message="With the velocity reversed, your velocity Verlet does not come back to where it began.",
        help="The step must be the same forwards and backwards: half a kick at each end, or half a drift "
        "at each.",
        diagnose=lambda: probes.of_step(submission, VERLET),
    )


@pytest.mark.task(VERLET)
@pytest.mark.points(1)
def test_verlet_free_fall(submission, rng):
    """Velocity Verlet in free fall"""
    bundles.expect_free_fall(submission, VERLET, rng)


@pytest.mark.task(VERLET)
@pytest.mark.points(1)
def test_verlet_evaluations(submission, rng):
    """Velocity Verlet's evaluations of the acceleration in a step"""
    accel, t, q, v, h = bundles.unknown_system(rng)
    end = accel.during(lambda: submission.call(VERLET, accel, t, q, v, h))
    bundles.expect_evaluations(accel, (1, 2))
    kit.as_pair(end, 3)


@pytest.mark.task(VERLET)
@pytest.mark.points(2)
def test_verlet_inputs(submission, rng):
    """Velocity Verlet: its arguments, zeros, whole numbers, places far away"""
    bundles.expect_clean(submission, VERLET, rng)


# -- Runge-Kutta 4 --------------------------------------------------------------------------------------


@pytest.mark.task(RK4)
@pytest.mark.points(5)
def test_rk4_order_everywhere(submission, rng):
    """RK4's order on six different problems"""
    bundles.expect_orders(submission, RK4, [make(rng) for make in bundles.EVERYTHING])


@pytest.mark.task(RK4)
@pytest.mark.points(3)
def test_rk4_decay(submission, rng):
    """RK4's loss of energy on a spring"""
    omega, z, n = rng.uniform(0.5, 5.0), rng.uniform(0.6, 1.2), 30
    system, h = systems.Oscillator(omega), z / omega
    start = bundles.signed(rng, 0.5, 1.5).tolist(), (omega * bundles.signed(rng, 0.3, 1.0)).tolist()
    _, q, v = submission.march(RK4, system, *start, h, n)
    energy = invariants.energy(system, q, v)
    with np.errstate(all="ignore"):
        loss = 1.0 - float((energy[-1] / energy[0]) ** (1 / n))
    expected = z**6 / 72 - z**8 / 576
    kit.expect_close(
        loss,
        expected,
        rel=1e-6,
        source="exact for every fourth-order method with four stages on a linear spring",
        quantity="energy lost per step",
        input={"omega": omega, "h": h, "steps": n, "q0": start[0], "v0": start[1]},
        message="On a spring, RK4 loses about z**6/72 of its energy a step with z = h*omega; yours does not.",
        help="Check which slope each stage starts with, how far along it goes, and the weights.",
        diagnose=lambda: probes.of_energy(submission, RK4, -loss, -expected, (system, *start, h, n, 0.0)),
    )


@pytest.mark.task(RK4)
@pytest.mark.points(1)
def test_rk4_free_fall(submission, rng):
    """RK4 in free fall"""
    bundles.expect_free_fall(submission, RK4, rng)


@pytest.mark.task(RK4)
@pytest.mark.points(2)
def test_rk4_inputs(submission, rng):
    """RK4: its arguments, zeros, whole numbers, places far away"""
    bundles.expect_clean(submission, RK4, rng)


# -- integrate ------------------------------------------------------------------------------------------


@pytest.mark.task("integrate")
@pytest.mark.points(3)
def test_integrate_time(submission, rng):
    """The times that integrate tells its steps"""
    loops.expect_times(submission, rng)


@pytest.mark.task("integrate")
@pytest.mark.points(2)
def test_integrate_refuses(submission, rng):
    """Which durations integrate refuses, and which it takes"""
    loops.expect_awkward_durations(submission, rng)
    loops.expect_refusals(submission, rng)


@pytest.mark.task("integrate")
@pytest.mark.points(2)
def test_integrate_whole_numbers(submission, rng):
    """integrate from a state of whole numbers"""
    loops.expect_whole_numbers(submission, rng)


# -- observed_order -------------------------------------------------------------------------------------


@pytest.mark.task("observed_order")
@pytest.mark.points(3)
def test_observed_order_least_squares(submission, rng):
    """Points that scatter, fitted by least squares"""
    hs = 0.3 * np.cumprod(rng.uniform(0.4, 0.8, 7))
    errors = rng.uniform(0.1, 10.0) * hs ** rng.uniform(0.8, 4.5) * np.exp(rng.normal(0.0, 0.2, 7))
    message = "observed_order is not the least-squares slope of these points."
    points = [(hs, errors), *bundles.cases.scattered(rng)]
    bundles.expect_slopes(submission, [(*given, message) for given in points])


@pytest.mark.task("observed_order")
@pytest.mark.points(3)
def test_observed_order_any_order(submission, rng):
    """Two points or many, in any order, as lists or arrays"""
    two = 10 ** rng.uniform(-4, -1, 2)
    many = rng.permutation(0.5 * np.cumprod(rng.uniform(0.4, 0.8, 5)))
    points = []
    for hs in (np.sort(two), np.sort(two)[::-1], many):
        errors = rng.uniform(1e-6, 1e3) * hs ** rng.uniform(0.8, 4.5)
        message = "For points on one line, two or many, in any order, observed_order is not the slope."
        points.append((hs, errors, message))
        points.append((hs.tolist(), errors.tolist(), message))
    bundles.expect_slopes(submission, points)


# -- max_stable_step ------------------------------------------------------------------------------------


@pytest.mark.task("max_stable_step")
@pytest.mark.points(3)
def test_stable_step_limits(submission, rng):
    """The limits of maps that nobody has seen"""
    a, b, c = rng.uniform(0.6, 5.0, 3)
    angle, shear = rng.uniform(0.4, 1.2), rng.uniform(1.2, 3.0)
    spiral = [0.8, 0.0, 0.2 / a**2]
    maps = (
        # A spiral that shrinks, then grows past z = a.
        (
            _scaled(spiral, math.cos(angle)),
            _scaled(spiral, math.sin(angle)),
            _scaled(spiral, -math.sin(angle)),
            None,
            a,
        ),
        # One eigenvalue passes -1 at z = b; a shear makes every norm larger than 1 from the start.
        ([0.6, 0.0, -1.6 / b**2], [shear], [0.0], [0.3], b),
        # The determinant is still small when one eigenvalue passes 1 at z = c.
        ([0.1], [0.0], [rng.uniform(-0.5, 0.5)], [0.7, 0.3 / c], c),
    )
    message = "The largest stable step of a map is wrong."
    steps = [(systems.LinearStep(qq, qp, pq, qq if pp is None else pp), z) for qq, qp, pq, pp, z in maps]
    steps.append((bundles.cases.slow_growth(c), c))
    # Springs so slow or so fast that a range in seconds is not one in h omega.
    omegas = rng.permutation(rng.uniform((0.1, 0.2, 2.0, 45.0), (0.15, 20.0, 20.0, 60.0))).tolist()
    # So fast, and unstable so soon, that no error in seconds is small: a search that ends at a millisecond
    # may be right once by chance (one time in twenty), not three times.
    for near in rng.uniform(0.2, 0.5, 3):
        steps.append((bundles.cases.slow_growth(near), near))
        omegas.append(rng.uniform(45.0, 60.0))
    bundles.expect_limits(
        submission,
        [(step, float(omega), limit, message) for (step, limit), omega in zip(steps, omegas, strict=True)],
    )


@pytest.mark.task("max_stable_step")
@pytest.mark.points(2)
def test_stable_step_pocket(submission, rng):
    """Maps that are stable again at larger steps"""
    low = rng.uniform(0.8, 2.0)
    high = low + rng.uniform(0.6, 1.0)
    curve = 1.5 / (
        low * high
    )  # the radius starts at 0.5 and rises 0.02 to 0.2 above one between low and high
    growth = [1 - curve * low * high, curve * (low + high), -curve]
    step = systems.LinearStep(growth, [0.0], [0.0], [0.2])
    message = (
        "For a map that is unstable in a range of steps and stable again beyond it, the result is not the "
        "start of that range."
    )
    narrow = [
        (bundles.cases.pocket(low), rng.uniform(*omegas), low, message)
        for low, omegas in zip(bundles.cases.starts(rng), cycle(((0.2, 20.0), (45.0, 60.0))))
    ]
    bundles.expect_limits(submission, [(step, rng.uniform(0.2, 20.0), low, message), *narrow])


@pytest.mark.task("max_stable_step")
@pytest.mark.points(2)
def test_stable_step_edges(submission, rng):
    """Limits at the ends of the search: zero, infinity and beside them"""
    euler = systems.LinearStep([1.0], [0.0, 1.0], [0.0, -1.0], [1.0])
    calm = systems.LinearStep([0.5, rng.uniform(0.01, 0.04)], [0.1], [0.0], [0.4])
    never = "For a map that is unstable at every step, the result is not zero."
    always = "For a map that is stable at every step of the search, the result is not infinite."
    beyond = bundles.cases.slow_growth(rng.uniform(10.3, 12.0))
    # The search begins at h omega = 0.05: what is unstable there has no stable step, and what is so soon has.
    before, soon = rng.uniform((0.03, 0.06), (0.045, 0.09)).tolist()
    early = "The largest stable step of a map that becomes unstable early is wrong."
    bundles.expect_limits(
        submission,
        [
            (euler, rng.uniform(0.2, 20.0), 0.0, never),
            (calm, rng.uniform(0.2, 20.0), math.inf, always),
            (probes.IDENTITY, float(2.0 ** rng.integers(-2, 5)), math.inf, always),  # nothing is rounded
            (beyond, rng.uniform(0.2, 20.0), math.inf, always),
            (bundles.cases.slow_growth(before), rng.uniform(0.2, 20.0), 0.0, early),
            (bundles.cases.slow_growth(soon), rng.uniform(0.2, 20.0), soon, early),
        ],
    )


def _scaled(coefficients, factor):
    return [factor * c for c in coefficients]
