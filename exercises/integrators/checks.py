"""Public checks of ``integrators``: run as often as you like, and once more when you submit."""

from __future__ import annotations

import math
from itertools import cycle

import numpy as np
import pytest

from course.physics import invariants, systems
from course.scoring import kit

probes = kit.companion("integrators", "probes")
cases = kit.companion("integrators", "cases")


def _signed(draw, low, high, d=1):
    """Numbers of either sign, never near zero."""
    return draw.uniform(low, high, d) * draw.choice([-1.0, 1.0], d)


@pytest.mark.task("explicit_euler_step")
@pytest.mark.points(5)
def test_explicit_euler_growth(submission, draw):
    """Explicit Euler's gain of energy on a spring"""
    task, omega, h, n = "explicit_euler_step", 2.0, 0.05, 40
    q0, v0 = [8.0], [4.8]  # so far out that a position taken for an angle shows
    if draw is not None:
        omega, q0 = float(draw.uniform(0.8, 4.0)), _signed(draw, 4.0, 9.0).tolist()
        h, v0 = float(draw.uniform(0.06, 0.14)) / omega, (omega * _signed(draw, 2.0, 6.0)).tolist()
    spring = systems.Oscillator(omega=omega)
    _, q, v = submission.march(task, spring, q0, v0, h, n)
    energy = invariants.energy(spring, q, v)
    factor = _mean_factor(energy)
    kit.expect_close(
        factor,
        1 + (h * spring.omega) ** 2,
        rel=1e-6,
        source="exact for a linear spring: only rounding is allowed",
        quantity="energy factor per step",
        input={"omega": omega, "h": h, "steps": n, "q0": q0, "v0": v0},
        message="On a spring, explicit Euler multiplies the energy by 1 + (h*omega)**2 in every step; yours "
        "does not.",
        help="The formula is q' = q + h v and v' = v + h a, with nothing new on the right.",
        diagnose=lambda: probes.of_energy(
            submission, task, factor - 1, (h * spring.omega) ** 2, (spring, q0, v0, h, n, 0.0)
        ),
    )


@pytest.mark.task("semi_implicit_euler_step")
@pytest.mark.points(5)
def test_semi_implicit_energy(submission, draw):
    """Semi-implicit Euler's energy on a spring"""
    # At this z 400 samples come near the extreme, whatever the spring and the amplitude.
    task, omega, z, n, q0 = "semi_implicit_euler_step", 2.0, 0.54, 400, [8.0]
    if draw is not None:
        omega, q0 = float(draw.uniform(0.8, 4.0)), _signed(draw, 4.0, 9.0).tolist()
    spring, h = systems.Oscillator(omega=omega), z / omega
    _, q, v = submission.march(task, spring, q0, [0.0], h, n)
    swing = _largest_change(invariants.energy(spring, q, v))
    kit.expect_close(
        swing,
        z / (2 - z),
        rel=0.01,
        source="closed form from rest; 400 samples come within 0.1 % of the extreme",
        quantity="max |dE|/E0",
        input={"omega": omega, "h": h, "steps": n, "q0": q0, "v0": [0.0]},
        message="From rest on a spring, semi-implicit Euler's energy varies by z/(2 - z) with z = h*omega; "
        "yours does not.",
        help="One form is v' = v + h a, then q' = q + h v'. The other begins with the position.",
        diagnose=lambda: probes.of_swing(
            submission, task, swing, z / (2 - z), (spring, q0, [0.0], h, n, 0.0)
        ),
    )


@pytest.mark.task("velocity_verlet_step")
@pytest.mark.points(6)
def test_verlet_order(submission, draw):
    """Velocity Verlet's error on a driven spring, at shorter and shorter steps"""
    _expect_order(submission, "velocity_verlet_step", [16, 32, 64], 0.1, draw)


@pytest.mark.task("rk4_step")
@pytest.mark.points(5)
def test_rk4_order(submission, draw):
    """RK4's error on a driven spring, at shorter and shorter steps"""
    _expect_order(submission, "rk4_step", [8, 16, 32], 0.3, draw)


@pytest.mark.task("rk4_step")
@pytest.mark.points(2)
def test_rk4_evaluations(submission, draw):
    """RK4's evaluations of the acceleration in a step"""
    pendulum = systems.Pendulum(g=9.81, length=1.0)
    q, v = np.array([0.8]), np.array([-0.3])
    if draw is not None:
        q, v = _signed(draw, 0.4, 1.2), _signed(draw, 0.4, 1.2)
    for h in (0.1, 2.5):
        accel = kit.acceleration(pendulum, 1)
        end = accel.during(lambda h=h, accel=accel: submission.call("rk4_step", accel, 0.0, q, v, h))
        kit.expect_evaluations(
            accel.count,
            [4],
            input={**pendulum.params(), "q": q, "v": v, "h": h},
            message="A step of RK4 does not take four evaluations of accel.",
            diagnose=lambda accel=accel: probes.of_evaluations(accel.count, [4]),
        )
        kit.as_pair(end, 1)


def _spiral(angle, shrink):
    """A rotation (rad) that also shrinks a little: where it leads is known at every step."""
    return cases.turn(shrink * math.cos(angle), shrink * math.sin(angle))


@pytest.mark.task("integrate")
@pytest.mark.points(4)
def test_integrate_samples(submission, draw):
    """The samples of integrate, and the state it carries along"""
    h, n, omega, angle, shrink = 0.25, 8, 2.0, 0.4, 0.98
    q0, v0 = np.array([1.0, -0.5]), np.array([0.5, 2.0])
    if draw is not None:
        n, angle = int(draw.integers(6, 14)), float(draw.uniform(0.3, 0.6))
        q0, v0 = _signed(draw, 0.5, 1.5, 2), _signed(draw, 0.5, 2.0, 2)
    # As many steps of another size besides: nothing of one path may be left in the other.
    for size in (h / 2, h):
        _expect_samples(submission, omega, (angle, shrink), (q0, v0), (n, size))


def _expect_samples(submission, omega, spiral, start, steps):
    """The samples of a path of n steps of h that each turn by an angle and shrink."""
    (angle, shrink), (q0, v0), (n, h) = spiral, start, steps
    step = cases.turn(shrink * math.cos(angle), shrink * math.sin(angle), h * omega)
    value = submission.call("integrate", step, systems.Oscillator(omega), q0, v0, n * h, h)
    given = {"step": "a known linear map", "q0": q0, "v0": v0, "t_end": n * h, "h": h}
    t, q, v = cases.histories(value)
    t = kit.as_vector(t, None, "t")
    kit.expect_length(
        t,
        n + 1,
        message="integrate does not return N + 1 times for N steps.",
        help="N = round(t_end / h) steps connect N + 1 states, each with its time.",
        input=given,
        diagnose=lambda: probes.of_count(submission, n, h, q),
    )
    q, v = kit.as_array(q, (n + 1, 2), "q"), kit.as_array(v, (n + 1, 2), "v")
    turned, left = angle * np.arange(n + 1)[:, None], shrink ** np.arange(n + 1)[:, None]
    p0 = v0 / omega
    q_true = left * (np.cos(turned) * q0 + np.sin(turned) * p0)
    v_true = omega * left * (np.cos(turned) * p0 - np.sin(turned) * q0)
    times = h * np.arange(n + 1)
    states = (
        "The samples are not the states that the step goes through.",
        "Row 0 is the initial state; row i + 1 is what the step makes of row i.",
    )
    times_of = ("The times of the samples are wrong.", "Sample i belongs to the time i h.")
    for actual, expected, quantity, units, (message, advice) in (
        (t, times, "t", "s", times_of),
        (q, q_true, "q", "m", states),
        (v, v_true, "v", "m/s", states),
    ):
        kit.expect_array(
            actual,
            expected,
            abs=1e-9,
            source="rounding",
            quantity=quantity,
            units=units,
            t=times,
            input=given,
            message=message,
            help=advice,
            diagnose=lambda: probes.of_rows(t, q, v, h, (q_true, v_true)),
        )


@pytest.mark.task("integrate")
@pytest.mark.points(4)
def test_integrate_counts(submission, draw):
    """How many steps integrate takes"""
    step = _spiral(0.4, 0.98)
    durations = ((0.29, 0.01, 29), (0.8, 0.1, 8), (1.1, 0.1, 11), (0.0, 0.1, 0))
    if draw is not None:
        durations = (*_awkward(draw), (0.0, float(draw.uniform(0.05, 0.2)), 0))
    for t_end, h, n in durations:
        given = {"q0": [1.0], "v0": [0.0], "t_end": t_end, "h": h}
        value = kit.expect_accepts(
            lambda t_end=t_end, h=h: submission.call(
                "integrate", step, systems.Oscillator(1.0), np.array([1.0]), np.array([0.0]), t_end, h
            ),
            "ValueError",
            input=given,
            message="integrate raises ValueError for a duration that is a whole number of steps.",
            diagnose=lambda t_end=t_end: probes.of_refusal(
                submission, np.array([1.0]), np.array([0.0]), t_end
            ),
        )
        t, q, v = cases.histories(value)
        for rows, name in ((t, "t"), (q, "q"), (v, "v")):
            kit.expect_length(
                rows,
                n + 1,
                name=name,
                input=given,
                message=f"The length of `{name}` is not N + 1 with N = round(t_end / h).",
                help="Take N = round(t_end / h) steps. Row 0 is the initial state, and each step adds a row."
                if n
                else "Without a step there is one sample: the initial state.",
                diagnose=lambda name=name, n=n, h=h, q=q: (
                    probes.of_count(submission, n, h, q) if name == "t" else None
                ),
            )
        kit.as_array(q, (n + 1, 1), "q"), kit.as_array(v, (n + 1, 1), "v")


@pytest.mark.task("integrate")
@pytest.mark.points(0)
def test_integrate_refusals(submission, draw):
    """Which durations integrate refuses"""
    durations = ((1.1, 0.2), (0.0400001, 0.0001), (60.0000006, 0.2)) if draw is None else cases.refused(draw)
    cases.expect_refusals(submission, (np.array([1.0]), np.array([0.0])), durations)
    cases.expect_taken(submission, (np.array([1.0]), np.array([0.0])), [(1.00000004, 0.1), (0.99999996, 0.1)])


def _awkward(draw):
    """Three durations: t_end/h falls short, a running sum of h does, np.arange has an entry too many."""
    found = []
    while len(found) < 3:
        n, h = int(draw.integers(8, 60)), int(draw.integers(7, 400)) / 1000
        t_end, t = round(n * h, 3), 0.0
        while t < t_end:
            t += h
        misses = t_end / h < n, t - t_end > h / 2, len(np.arange(0, t_end + h, h)) > n + 1
        found += [(t_end, h, n)] * misses[len(found)]
    return found


@pytest.mark.task("observed_order")
@pytest.mark.points(4)
def test_observed_order_slope(submission, draw):
    """Errors that were made with one power of h"""
    hs, orders = [0.1, 0.05, 0.025, 0.0125], ((3.0, 1.0), (0.2, 2.0), (7.0, 4.0))
    if draw is not None:
        hs = (0.3 * np.cumprod(draw.uniform(0.4, 0.7, 4))).tolist()
        orders = [(float(draw.uniform(0.1, 10.0)), float(draw.uniform(0.8, 4.5))) for _ in range(3)]
    cases = [(order, [factor * h**order for h in hs]) for factor, order in orders]
    values = submission.call_each("observed_order", [(np.array(hs), np.array(errors)) for _, errors in cases])
    for value, (order, errors) in zip(values, cases, strict=True):
        kit.expect_close(
            value,
            order,
            abs=1e-9,
            source="rounding: the points lie on one line",
            quantity="order",
            input={"hs": hs, "errors": errors},
            message="For errors of the form C * h**p, observed_order does not return p.",
            help="With x = log h and y = log error, the slope is sum (x - mean x)(y - mean y) over "
            "sum (x - mean x)**2.",
            diagnose=lambda value=value, errors=errors: probes.of_order(submission, value, hs, errors),
        )


@pytest.mark.task("observed_order")
@pytest.mark.points(0)
def test_observed_order_scattered(submission, draw):
    """Points that scatter, some of them small"""
    points = [
        ([0.1, 0.05, 0.02, 0.01], [0.02, 0.03, 0.004, 0.006]),
        ([0.3, 0.04, 0.006, 0.0009], [2e-3, 9e-7, 3e-10, 4e-15]),
        ([0.2, 0.1, 0.05, 0.02], [0.03, 0.004, 0.004, 0.0005]),
        ([0.4, 0.2, 0.1], [0.011, 0.02, 0.04]),
        ([0.2, 0.1, 0.04, 0.04], [0.03, 0.009, 0.002, 0.001]),
        ([0.4, 0.2, 0.1], [0.03, 0.03, 0.03]),
    ]
    if draw is not None:
        points = [(hs.tolist(), errors.tolist()) for hs, errors in cases.scattered(draw)]
    values = submission.call_each("observed_order", [(np.array(hs), np.array(e)) for hs, e in points])
    for value, (hs, errors) in zip(values, points, strict=True):
        kit.expect_close(
            value,
            # rounding leaves 1e-16 of a slope of zero
            round(invariants.convergence_order(hs, errors), 12) + 0.0,
            abs=1e-8,
            source="rounding: the least-squares slope is one number",
            quantity="order",
            input={"hs": hs, "errors": errors},
            message="observed_order does not return the least-squares slope of these points.",
            help="It is one line by least squares through log error over log h, all points as they are: "
            "equal weights, each error over its own step, nothing added, rounded or left out.",
            diagnose=lambda value=value, hs=hs, errors=errors: probes.of_order(submission, value, hs, errors),
        )


@pytest.mark.task("max_stable_step")
@pytest.mark.points(5)
def test_stable_step_verlet(submission, draw):
    """Velocity Verlet's limit, for any omega"""
    verlet = systems.LinearStep([1, 0, -0.5], [0, 1], [0, -1, 0, 0.25], [1, 0, -0.5])
    omegas = (
        (1.0, 50.0, 0.1)
        if draw is None
        else tuple(draw.uniform((0.8, 45.0, 0.1), (1.2, 60.0, 0.15)).tolist())
    )
    values = submission.call_each("max_stable_step", [(verlet, omega) for omega in omegas])
    for value, omega in zip(values, omegas, strict=True):
        cases.expect_limit(
            submission,
            value,
            (verlet, omega, 2.0),
            input={"step": "velocity Verlet's map on a spring", "omega": omega},
            message="The largest stable step of velocity Verlet is wrong.",
        )


@pytest.mark.task("max_stable_step")
@pytest.mark.points(0)
def test_stable_step_ends(submission, draw):
    """Zero, infinity, narrow unstable ranges, slow growth"""
    euler = systems.LinearStep([1.0], [0.0, 1.0], [0.0, -1.0], [1.0])
    calm = systems.LinearStep([0.5, 0.02], [0.1], [0.0], [0.4])
    starts, growing = (0.6, 0.92, 1.37, 2.15, 3.3, 8.2, 8.47, 8.74, 9.01), 2.6
    near, fast, beyond = 0.3, 60.0, 11.0
    if draw is not None:
        # A few: a hidden check has as many as it takes.
        starts, growing = cases.starts(draw)[::3], float(draw.uniform(1.0, 5.0))
        near, fast, beyond = draw.uniform((0.2, 45.0, 10.3), (0.5, 60.0, 12.0)).tolist()
    maps = [(euler, 1.3, 0.0, "one that is unstable at every step")]
    maps += [(calm, 1.3, math.inf, "one that never is")]
    # A double eigenvalue makes 1e-8 of a rounding, and a power of two rounds nothing.
    maps += [(probes.IDENTITY, 2.0, math.inf, "one that changes nothing: both eigenvalues are 1")]
    kind = "one that is unstable in a narrow range"
    maps += [(cases.pocket(low), omega, low, kind) for low, omega in zip(starts, cycle((1.3, fast)))]
    maps += [(cases.slow_growth(growing), 1.3, growing, "one whose growth is slow")]
    maps += [(cases.slow_growth(near), fast, near, "one that is soon unstable, on a fast spring")]
    maps += [(cases.slow_growth(beyond), 1.3, math.inf, "one that is unstable beyond 10/omega only")]
    values = submission.call_each("max_stable_step", [(step, omega) for step, omega, _, _ in maps])
    for value, (step, omega, limit, kind) in zip(values, maps, strict=True):
        cases.expect_limit(
            submission,
            value,
            (step, omega, limit),
            input={"step": kind, **step.params(), "omega": omega},
            message="The largest stable step of a made-up map is wrong.",
        )


@pytest.mark.task("explicit_euler_step")
@pytest.mark.points(0)
def test_explicit_euler_arguments(submission):
    """One step: its arguments, zeros, whole numbers, places far away"""
    _expect_clean(submission, "explicit_euler_step")


@pytest.mark.task("semi_implicit_euler_step")
@pytest.mark.points(0)
def test_semi_implicit_arguments(submission):
    """One step: its arguments, zeros, whole numbers, places far away"""
    _expect_clean(submission, "semi_implicit_euler_step")


@pytest.mark.task("velocity_verlet_step")
@pytest.mark.points(0)
def test_verlet_arguments(submission):
    """One step: its arguments, zeros, whole numbers, places far away"""
    _expect_clean(submission, "velocity_verlet_step")


@pytest.mark.task("rk4_step")
@pytest.mark.points(0)
def test_rk4_arguments(submission):
    """One step: its arguments, zeros, whole numbers, places far away"""
    _expect_clean(submission, "rk4_step")


@pytest.mark.task("integrate")
@pytest.mark.points(0)
def test_integrate_arguments(submission):
    """The arguments of integrate, and whole numbers"""
    q0, v0, h, n = np.array([2, -1]), np.array([1, 3]), 0.25, 4
    args = [_spiral(0.4, 0.98), systems.Oscillator(2.0), q0, v0, n * h, h]
    given = {"q0": q0, "v0": v0, "t_end": n * h, "h": h}
    inspected = kit.expect_accepts(
        lambda: submission.call_inspect("integrate", *args),
        "TypeError",
        input=given,
        message="integrate fails on an initial state of whole numbers.",
        diagnose=lambda: probes.of_whole_start(submission, args),
    )
    _, q, _ = cases.histories(inspected.value)
    q = kit.as_array(q, (n + 1, 2), "q")
    kit.expect_true(
        not np.array_equal(q, np.trunc(q)),
        "From an initial state of whole numbers, all positions that integrate returns are whole numbers.",
        input=given,
        diagnose=lambda: probes.of_whole_rows(submission, args, q),
    )
    cases.expect_start_kept(submission, args, inspected, given)
    cases.expect_calls(submission)


def _expect_clean(submission, task):
    """What ``cases.expect_clean`` asks, on a spring."""
    cases.expect_clean(submission, task, systems.Oscillator(2.0), 0.5, ([2, -1], [1, 3]), 0.2)


#: Numbers of steps for drawn springs: at these the slopes of correct methods keep within the same limits.
DRAWN_COUNTS = {"velocity_verlet_step": (24, 48, 96), "rk4_step": (32, 48, 72)}


def _driven_spring(draw):
    rate = float(draw.uniform(0.8, 3.0))
    spring = systems.ForcedOscillator(
        rate, rate**2 * float(draw.uniform(0.6, 1.4)), rate * float(draw.uniform(1.3, 1.8))
    )
    return kit.Problem(
        "driven spring",
        spring,
        _signed(draw, 0.5, 1.2).tolist(),
        (rate * _signed(draw, 0.3, 0.9)).tolist(),
        rate=rate,
        span=float(draw.uniform(1.2, 1.9)) / rate,
        t0=float(draw.uniform(0.2, 2.0)),
    )


def _mean_factor(energy):
    """By what factor the energy changes per step, on average."""
    with np.errstate(all="ignore"):
        return float((energy[-1] / energy[0]) ** (1 / (len(energy) - 1)))


def _largest_change(energy):
    with np.errstate(all="ignore"):
        return float(np.max(np.abs(invariants.relative_change(energy))))


def _expect_order(submission, task, counts, within, draw):
    """The slope of log error over log step on one driven spring."""
    problem = kit.Problem(
        "driven spring", systems.ForcedOscillator(2.0, 1.5, 3.1), [0.8], [-0.9], rate=2.0, span=0.9, t0=0.4
    )
    if draw is not None:
        problem, counts = _driven_spring(draw), DRAWN_COUNTS[task]
    hs, errors = kit.march_errors(submission, task, problem, counts)
    kit.expect_order(
        hs,
        errors,
        probes.ORDERS[task],
        abs=within,
        source="slopes of correct methods at these steps, with a margin",
        input=problem.input,
        message="On a spring that is pushed in time, the error does not shrink with the step as it should.",
        help="Compare one step with the formula: its factors, and the time, position and velocity of each "
        "evaluation. Here the acceleration depends on t.",
        diagnose=lambda: probes.of_order_measured(submission, task, hs, errors, problem.run(counts[0])),
    )
