"""Finding out which mistake a failed check looks like, for the exercise ``integrators``.

A step is recognised by what it does: one step of it on a problem where every argument matters is compared
with what the textbook methods and the usual wrong formulas give there. Whatever matches to rounding is
named. Where nothing matches, properties are tried: does it see the time, does it converge, and how fast.
"""

from __future__ import annotations

import itertools
import math

import numpy as np

from course.grading import kit
from course.physics.exact import reference
from course.physics.integrators import (
    RK4,
    ExplicitEuler,
    SemiImplicitEuler,
    State,
    VelocityVerlet,
    trajectory,
)
from course.physics.systems import DrivenPendulum, LinearStep, Oscillator

named = kit.companion("integrators", "diagnosis").named
_formulas = kit.companion("integrators", "formulas")
RIGHT = _formulas.RIGHT

ORDERS = {"explicit_euler_step": 1, "semi_implicit_euler_step": 1, "velocity_verlet_step": 2, "rk4_step": 4}

#: A generic step on a problem where time, position and velocity all matter. Verlet gets it without damping,
#: where its two forms are defined.
_T, _H = 0.6, 0.31
_Q, _V = np.array([0.7, -0.4]), np.array([0.3, 1.1])


def _problem(task):
    return DrivenPendulum(3.1, 0.0 if task == "velocity_verlet_step" else 0.7, 1.9, 2.3)


def of_step(submission, task, run=None):
    """The mistake that a failed check of a step looks like, and where its path leaves the right one.

    run: what the check marched along, (system, q0, v0, h, n, t0).
    """
    if _mixes_arguments(submission, task):
        return named("ACCEL_ARGUMENTS_MIXED")
    if _remembers(submission, task):
        return named("STALE_CACHE")
    system = _problem(task)
    q, v = kit.as_pair(submission.call(task, system, _T, _Q, _V, _H), 2)
    code = _formula(task, system, q, v) or _blind_spot(submission, task) or _rate(submission, task)
    left = kit.attempt(lambda: _divergence(submission, task, *run)) if run else None
    return named(code, left) if code else None


def of_whole_numbers(submission, task):
    """Why a step from integers differs from the same step from floats."""
    return named("STALE_CACHE" if _remembers(submission, task) else "INTEGER_STATE")


def _mixes_arguments(submission, task):
    """Whether accel gets a vector in the time's place, or the velocity in the position's."""
    # Without acceleration the velocity stays what it is in the whole step, and no position equals it.
    accel = kit.counted(lambda *args, **names: np.zeros(2))
    kit.attempt(lambda: submission.call(task, accel, _T, _Q, _V, _H))
    places = ([kit.attempt(lambda arg=arg: kit.as_vector(arg, 2)) for arg in call] for call in accel.calls)
    return any(
        len(place) == 3 and (place[0] is not None or (place[1] is not None and np.allclose(place[1], _V)))
        for place in places
    )


def _remembers(submission, task):
    """Whether the same call gives something else after a call of another kind."""
    system = _problem(task)
    first = kit.as_pair(submission.call(task, system, _T, _Q, _V, _H), 2)
    submission.call(task, Oscillator(1.3), _T + 1.0, -_V, _Q, _H)
    return not _equal(first, kit.as_pair(submission.call(task, system, _T, _Q, _V, _H), 2))


def of_energy(submission, task, change, expected, run=None):
    """Like ``of_step``; where the formula is not recognised, by how the energy of a spring changes.

    change, expected: of the energy per step, as a share of it, as measured and as the method has it.
    """
    found = kit.attempt(lambda: of_step(submission, task, run))
    if found or math.isnan(change):
        return found
    if change > expected:
        return named("ENERGY_GROWS" if change > 0 else "ENERGY_FADES_TOO_LITTLE")
    return named("ENERGY_FADES" if change < 0 else "ENERGY_GROWS_TOO_LITTLE")


def of_swing(submission, task, swing, expected, run=None):
    """Like ``of_energy`` for a method whose energy swings: by how far it gets from its first value."""
    found = kit.attempt(lambda: of_step(submission, task, run))
    if found or not math.isfinite(swing):
        return found
    return named("ENERGY_SWINGS_TOO_FAR" if swing > expected else "ENERGY_SWINGS_TOO_LITTLE")


def _formula(task, system, q, v):
    """The code of the formula that gives exactly (q, v), or None."""
    with np.errstate(all="ignore"):
        for right in _formulas.RIGHT[task]:
            if _equal(right(system, _T, _Q, _V, _H), (q, v)):
                return None
        for code, wrong in _formulas.WRONG[task]:
            if _equal(wrong(system, _T, _Q, _V, _H), (q, v)):
                return code
        for right in _formulas.RIGHT[task]:
            for code, result in _slips(right, system):
                if _equal(result, (q, v)):
                    return code
    return "STATE_NOT_ADVANCED" if _equal((_Q, _V), (q, v)) else None


def _slips(right, system):
    """What a right formula gives with one slip around it."""
    q, v = right(system, _T, _Q, _V, _H)
    yield "RETURNS_SWAPPED", (v, q)
    yield "RETURNS_INCREMENT", (q - _Q, v - _V)
    yield "WRONG_SIGN", right(lambda t, q, v: -system(t, q, v), _T, _Q, _V, _H)
    yield "STEP_SIZE_MISSING", right(system, _T, _Q, _V, 1.0)


def _equal(a, b):
    return all(np.allclose(x, y, rtol=1e-9, atol=1e-12) for x, y in zip(a, b, strict=True))


def _blind_spot(submission, task):
    """What the step does not look at: the clock, or the velocity, where only that acts."""
    if ORDERS[task] == 1:
        return None
    clock = DrivenPendulum(0.0, 0.0, 1.9, 2.3)
    _, v = kit.as_pair(submission.call(task, clock, _T, _Q, _V, _H), 2)
    if np.allclose(v, _V + _H * clock(_T, _Q, _V), rtol=1e-9):
        return "STAGE_TIMES_FROZEN"
    drag = DrivenPendulum(0.0, 0.7, 0.0, 1.0)
    _, v = kit.as_pair(submission.call(task, drag, _T, _Q, _V, _H), 2)
    blind = task == "rk4_step" and np.allclose(v, _V + _H * drag(_T, _Q, _V), rtol=1e-9)
    return "STAGE_VELOCITY_IGNORED" if blind else None


def _rate(submission, task):
    """Whether smaller steps help as much as they should."""
    problem = kit.Problem("driven pendulum", _problem(task), list(_Q), list(_V), 2.0, 1.2, _T)
    hs, errors = kit.march_errors(submission, task, problem, [16, 32, 64])
    if not np.all(np.isfinite(errors)) or errors[-1] > 0.5 * errors[0]:
        return "DOES_NOT_CONVERGE"
    slope = math.log(errors[-2] / errors[-1]) / math.log(hs[-2] / hs[-1]) if errors[-1] > 0 else math.inf
    return "ORDER_TOO_LOW" if slope < ORDERS[task] - 0.4 else None


def _distance(a, b):
    """How unlike two states are: by the number of halves that differ, then by how much they do."""
    differ = sum(not _equal([x], [y]) for x, y in zip(a, b, strict=True))
    return differ, differ == 2 and sum(abs(x - y).max() for x, y in zip(a, b, strict=True))


def _divergence(submission, task, system, q0, v0, h, n, t0):
    """Where the path first leaves that of the right method, in the form that it shares most with at first.

    A step whose position is exactly that of one form is that form with a wrong velocity, however near another
    form may come to both.
    """
    t, q, v = submission.march(task, system, q0, v0, h, n, t0=t0)
    start = State.of(q0, v0, t0)
    paths = [trajectory(stepper, system, start, h, n) for stepper in _STEPPERS[task]]
    right = min(paths, key=lambda path: _distance((path.q[1], path.v[1]), (q[1], v[1])))
    allowed = 1e-9
    if task == "rk4_step":  # it has more forms than can be listed: allow three times the textbook's error
        true = reference(system, q0, v0, t[1:], t0)[0]
        allowed = 1e-9 + 3 * np.maximum.accumulate([0.0, *abs(right.q[1:] - true).max(axis=1)])
    return kit.first_divergence(t, {"q": q, "v": v}, {"q": right.q, "v": right.v}, allowed)


_STEPPERS = {
    "explicit_euler_step": [ExplicitEuler()],
    "semi_implicit_euler_step": [SemiImplicitEuler(), SemiImplicitEuler(position_first=True)],
    "velocity_verlet_step": [VelocityVerlet(), VelocityVerlet(drift_first=True)],
    "rk4_step": [RK4()],
}


def of_evaluations(count, allowed):
    """Too many evaluations, or too few."""
    return named("EXTRA_EVALUATIONS" if count > max(allowed) else "MISSING_EVALUATIONS")


# -- integrate ----------------------------------------------------------------------------------------

#: Durations and steps (s): a quotient just below a whole number, sums of h that fall short, a quotient just
#: above, and one without any rounding.
_DURATIONS = ((0.29, 0.01), (0.8, 0.1), (1.1, 0.1), (0.063, 0.009), (1.0, 0.25))
IDENTITY = LinearStep([1.0], [0.0], [0.0], [1.0])


def _loop_count(t_end, h, overshoot):
    t, n = 0.0, 0
    while t < t_end or (overshoot and t <= t_end):
        t, n = t + h, n + 1
    return n


_COUNTS = (
    ("OFF_BY_ONE_SAMPLE", lambda t_end, h: round(t_end / h) - 1),
    ("OFF_BY_ONE_SAMPLE", lambda t_end, h: round(t_end / h) + 1),
    ("TRUNCATED_AND_SHORT", lambda t_end, h: int(t_end / h) - 1),
    ("TRUNCATED_AND_SHORT", lambda t_end, h: int(t_end // h) - 1),
    ("TRUNCATED_STEP_COUNT", lambda t_end, h: int(t_end / h)),
    ("TRUNCATED_STEP_COUNT", lambda t_end, h: int(t_end // h)),
    ("STEP_COUNT_ROUNDED_UP", lambda t_end, h: math.ceil(t_end / h)),
    ("TIME_ACCUMULATES", lambda t_end, h: _loop_count(t_end, h, overshoot=False)),
    ("TIME_ACCUMULATES", lambda t_end, h: _loop_count(t_end, h, overshoot=True)),
    ("TIME_ACCUMULATES", lambda t_end, h: len(np.arange(0, t_end + h, h)) - 1),
)


def of_count(submission):
    """Which rule gives the number of samples that ``integrate`` returns."""
    rows = []
    for t_end, h in _DURATIONS:
        t, _, _ = kit.as_tuple(
            submission.call("integrate", IDENTITY, Oscillator(1.0), [1.0], [0.0], t_end, h), "tqv"
        )
        rows.append(len(kit.as_vector(t)))
    for code, rule in _COUNTS:
        if rows == [rule(t_end, h) + 1 for t_end, h in _DURATIONS]:
            return named(code)
    return None


def of_rows(t, q, v, h, states):
    """What is wrong with rows of the right number. ``states``: true q and v of every sample, (N+1, d)."""
    code = _histories(q, v, states) or _first_row(t, q, v, h, states) or _later_rows(q, v, states)
    return named(code) if code else None


def _histories(q, v, states):
    """What is wrong with the two arrays, whatever the step did."""
    q_true, v_true = states
    if np.allclose(q, v_true) and np.allclose(v, q_true):
        return "HISTORIES_SWAPPED"
    if np.array_equal(q, v) and np.any(q) and not np.allclose(q_true, v_true):
        return "HISTORIES_IDENTICAL"
    whole = np.array_equal(q, np.trunc(q)) and np.array_equal(q[0], np.trunc(q_true[0]))
    return "INTEGER_STATE" if whole and not np.array_equal(q_true, np.trunc(q_true)) else None


def _first_row(t, q, v, h, states):
    """What the first row is, if not the initial state at time 0."""
    late = len(t) > 1 and np.allclose(t, h * np.arange(1, len(t) + 1))
    pairs = list(zip((q, v), states, strict=True))
    if all(np.allclose(rows[0], true[0]) for rows, true in pairs):
        return "TIMES_START_LATE" if late else None
    after = len(q) > 1 and all(np.allclose(rows[0], true[1]) for rows, true in pairs)
    empty = all(np.allclose(rows[0], true[0]) or not np.any(rows[0]) for rows, true in pairs)
    return "INITIAL_STATE_MISSING" if after or empty else "INITIAL_STATE_WRONG"


def _later_rows(q, v, states):
    """What is wrong after a right first row."""
    q_true, _ = states
    if np.allclose(q[:-1], q_true[:-1]) and not np.any(q[-1]) and not np.any(v[-1]):
        return "LAST_STEP_MISSING"
    carried = len(q) <= 2 or not (np.allclose(q[2:], q[1]) and np.allclose(v[2:], v[1]))
    return None if carried else "STATE_NOT_CARRIED"


def of_times(times, h):
    """What is wrong with the times that ``integrate`` told its step. times: shape (N,), s."""
    if np.allclose(times, times[0]):
        return named("TIME_NOT_PASSED")
    if np.allclose(np.cumsum(times), h * np.arange(len(times))):
        return named("STATE_NOT_CARRIED")
    return named("TIME_AHEAD") if np.allclose(times, h * np.arange(1, len(times) + 1)) else None


# -- observed_order -----------------------------------------------------------------------------------


def of_order(value, hs, errors):
    """Which wrong slope through (hs, errors) the value is."""
    value, hs, errors = kit.as_number(value), np.asarray(hs), np.asarray(errors)
    for code, wrong in _slopes(hs, errors):
        if math.isclose(value, wrong, rel_tol=1e-6):
            return named(code)
    return None


def _slope(x, y):
    x = x - np.mean(x)
    return float(x @ y / (x @ x))


def _slopes(hs, errors):
    x, y = np.log(hs), np.log(errors)
    right = _slope(x, y)
    pairs = np.diff(y) / np.diff(x)
    sort = np.argsort(hs)
    yield "ORDER_ROUNDED", float(round(right))
    yield "ORDER_SLOPE_INVERTED", _slope(y, x)
    yield "ORDER_SLOPE_INVERTED", 1 / right
    yield "ORDER_SIGN_FLIPPED", -right
    yield "ORDER_SIGN_FLIPPED", _slope(x[::-1], y)
    yield "LOGARITHM_MISSING", _slope(hs, errors)
    yield "LOGARITHM_MISSING", _slope(hs, y)
    yield "LOGARITHM_MISSING", _slope(x, errors)
    yield "LOGARITHMS_MIXED", right / math.log(10)
    yield "LOGARITHMS_MIXED", right * math.log(10)
    yield "LOGARITHMS_MIXED", right / math.log(2)
    yield "LOGARITHMS_MIXED", right * math.log(2)
    for i, j in itertools.combinations(range(len(hs)), 2):
        yield "ORDER_FROM_ENDS", (y[i] - y[j]) / (x[i] - x[j])
    yield "ORDER_THROUGH_ORIGIN", float(x @ y / (x @ x))
    yield "ORDER_MEAN_OF_PAIRS", float(np.mean(pairs))
    yield "ORDER_MEAN_OF_PAIRS", float(np.mean(np.diff(y[sort]) / np.diff(x[sort])))
    yield "ORDER_MEAN_OF_PAIRS", float(np.median(pairs))


# -- max_stable_step ----------------------------------------------------------------------------------

Z_FIRST, Z_LAST = 0.05, 10.0
_GRID = np.linspace(Z_FIRST, Z_LAST, 1991)
#: What may be asked to stay below one, for many matrices at once, instead of the spectral radius.
_CRITERIA = (
    ("STABILITY_BY_NORM", lambda m: np.linalg.norm(m, 2, axis=(-2, -1))),
    ("STABILITY_BY_NORM", lambda m: np.linalg.norm(m, np.inf, axis=(-2, -1))),
    ("STABILITY_BY_NORM", lambda m: np.linalg.norm(m, 1, axis=(-2, -1))),
    ("STABILITY_BY_NORM", lambda m: np.linalg.norm(m, "fro", axis=(-2, -1))),
    ("STABILITY_BY_DETERMINANT", lambda m: abs(np.linalg.det(m))),
    ("STABILITY_BY_DETERMINANT", lambda m: abs(np.trace(m, axis1=-2, axis2=-1)) / 2),
    ("EIGENVALUES_WITHOUT_MODULUS", lambda m: np.linalg.eigvals(m).real.max(axis=-1)),
    ("EIGENVALUES_WITHOUT_MODULUS", lambda m: abs(np.linalg.eigvals(m).real).max(axis=-1)),
)
#: Maps that tell the criteria apart: sheared, with an eigenvalue of -1 at z = 1.5, spiralling out at 1.9.
_SHEARED = LinearStep([1, 0, -0.5], [0, 1], [0, -1, 0, 0.25], [1, 0, -0.5])
_FLIPPED = LinearStep([0.6, 0, -1.6 / 1.5**2], [2.0], [0.0], [0.3])
_SPIRAL = LinearStep([0.3, 0, 0.02], [0.75, 0, 0.05], [-0.75, 0, -0.05], [0.3, 0, 0.02])


def of_stability(submission, value, step, omega, limit):
    """Which wrong search gives this largest step. limit: the right h * omega."""
    z = kit.as_number(value) * omega
    for code, wrong in _searches(submission, step, omega, limit):
        if _same(wrong, z):
            return named(code)
    return named("SEARCH_TOO_COARSE") if 0.7 * limit < z < 1.3 * limit else None


def _searches(submission, step, omega, limit):
    """Codes and the h * omega that each mistake leads to, the most telling first."""
    # Drawn numbers may make h * omega look like h: another map at another omega decides.
    if _same(kit.as_number(submission.call("max_stable_step", _FLIPPED, 4.0)), 1.5):
        yield "RETURNS_Z", limit * omega
    # A search that takes no notice of the step finds the same limit for all.
    found = [kit.as_number(submission.call("max_stable_step", other, 1.0)) for other in (_FLIPPED, _SPIRAL)]
    if _same(*found):
        yield "ASSUMES_ITS_LIMIT", found[0]
    yield ("NO_ZERO", Z_FIRST) if limit == 0 else ("TOLERANCE_TOO_TIGHT", Z_FIRST)
    if limit == math.inf:
        yield "NO_INFINITY", Z_LAST
    found.append(kit.as_number(submission.call("max_stable_step", _SHEARED, 1.0)))
    for code, size in _CRITERIA:
        if all(map(_same, [_first_failure(other, size) for other in (_FLIPPED, _SPIRAL, _SHEARED)], found)):
            yield code, _first_failure(step, size)
    yield "TOLERANCE_TOO_TIGHT", 0.0
    for edge in _later_limits(step):
        yield "LARGEST_STABLE_STEP", edge


def _same(a, b):
    return a == b or (math.isfinite(a) and math.isclose(a, b, rel_tol=0.02))


def _first_failure(step, size):
    """Where ``size`` of the map first exceeds one, as max_stable_step would report it."""
    fails = np.flatnonzero(size(step.matrix(_GRID)) > 1 + 1e-8)
    if not fails.size:
        return math.inf
    return float(_GRID[fails[0]]) if fails[0] else 0.0


def _later_limits(step):
    """Every h * omega after the first limit at which the map turns unstable."""
    stable = abs(np.linalg.eigvals(step.matrix(_GRID))).max(axis=-1) <= 1 + 1e-8
    ends = np.flatnonzero(stable[:-1] & ~stable[1:])
    return [float(_GRID[i]) for i in ends[1:]] + ([math.inf] if stable[-1] else [])
