"""What a failed check of ``integrators`` shows of the mistake behind it.

Each probe looks for a property that a family of mistakes has: does a step see the time, does it converge and
how fast, what do the rows of a path have in common. Which known program it is, ``hypotheses.json`` tells; a
probe speaks where none of them fits.
"""

from __future__ import annotations

import functools
import math

import numpy as np

from course.physics.exact import reference
from course.physics.integrators import (
    RK4,
    ExplicitEuler,
    SemiImplicitEuler,
    State,
    VelocityVerlet,
    trajectory,
)
from course.physics.invariants import convergence_order
from course.physics.systems import DrivenPendulum, FreeFall, LinearStep, Oscillator
from course.scoring import kit

named = kit.words("integrators")

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
    if _looks_elsewhere(submission, task):
        return named("TIME_OUTSIDE_STEP")
    if _wraps(submission, task):
        return named("POSITION_WRAPPED")
    if not all(map(np.all, map(np.isfinite, _generic(submission, task)))):
        return None  # the check says that it is nan, or infinite; nothing else may be read off it
    if _remembers(submission, task):
        return named("STALE_CACHE")
    code = (
        _weights(submission, task)
        or _blind_spot(submission, task)
        or kit.attempt(lambda: _stage(submission, task))
        or _digits(submission, task)
    )
    left = kit.attempt(lambda: _divergence(submission, task, *run)) if run else None
    return named(code, left) if code else None


def of_zeros(submission, task):
    """Whether steps that do not add up where a state is zero do so, on a spring, from other states.

    From large ones, too: a speed that is limited adds up only below the limit.
    """
    pairs = ((_Q, _V), (2 * _V, _Q), (_Q + 2 * _V, _V + _Q))
    for size in (1.0, 20.0):
        calls = [(Oscillator(1.7), _T, size * q, size * v, _H) for q, v in pairs]
        one, other, both = (np.array(kit.as_pair(value, 2)) for value in submission.call_each(task, calls))
        if not np.allclose(one + other, both, rtol=1e-9, atol=1e-12):
            return None
    return named("ZERO_IS_SPECIAL")


def of_whole_numbers(submission, task):
    """Why a step from integers differs from the same step from floats, or fails.

    It need not end in whole numbers: the slopes on the way may have lost their fractions.
    """
    kept = kit.attempt(lambda: _remembers(submission, task))
    return named("STALE_CACHE" if kept else "INTEGER_STATE")


def _wraps(submission, task):
    """Whether a body at rest without forces is elsewhere, if it is far away and only then.

    After the step, or where ``accel`` is asked for.
    """

    def places(at):
        accel = kit.counted(lambda *args, **names: np.zeros(2))
        after = kit.attempt(lambda: kit.as_pair(submission.call(task, accel, _T, at, 0 * _Q, _H), 2)[0])
        asked = [
            kit.attempt(lambda call=call: kit.as_vector(call[1], 2)) for call in accel.calls if len(call) == 3
        ]
        return [after, *asked]

    near, far = abs(_Q), places(1000 * _Q)  # a range may begin at zero
    return (
        all(_stays(place, near) for place in places(near))
        and not any(place is None or place.shape != _Q.shape for place in far)
        and not all(_stays(place, 1000 * _Q) for place in far)
    )


def _stays(place, at):
    return place is not None and np.allclose(place, at, rtol=1e-9, atol=1e-12)


def _generic(submission, task):
    """Position and velocity after a step in which everything matters."""
    return kit.as_pair(submission.call(task, _problem(task), _T, _Q, _V, _H), 2)


def _weights(submission, task):
    """On a constant acceleration a method of more than one stage shows whether its weights add up to one."""
    if ORDERS[task] == 1:
        return None
    shares = _shares(submission, task)
    if task == "velocity_verlet_step" and math.isclose(sum(shares), 1.0) and 1e-6 < min(shares) < 0.5 - 1e-6:
        return "KICKS_UNEQUAL"
    if task == "rk4_step" and 1e-6 < max(abs(np.subtract(shares, [1 / 6, 1 / 3, 1 / 3, 1 / 6]))) < 1e-3:
        return "WEIGHTS_ROUNDED"
    kick, other = (_weight(submission, task, h) for h in (0.37, 0.2))
    if task != "rk4_step" or not kick or not other or math.isclose(kick, 1.0, rel_tol=1e-6):
        return None
    # A weight is a number: what changes with the step is a power of it.
    if math.isclose(kick, other, rel_tol=1e-6):
        return "WEIGHTS_DO_NOT_ADD_UP"
    return "POWER_OF_STEP_WRONG" if math.isclose(kick / other, 0.37 / 0.2, rel_tol=1e-6) else None


#: m/s²; so large that a rounded velocity does not look like a rounded weight.
_PUSH = 1e6


def _shares(submission, task):
    """How much of each acceleration in turn goes into the new velocity, as a share of the step."""
    calls, shares = {"velocity_verlet_step": 2, "rk4_step": 4}[task], []
    for i in range(calls):
        given = iter([np.full(2, _PUSH * (i == k)) for k in range(calls)])
        accel = kit.counted(lambda *args, given=given, **names: next(given, np.zeros(2)))
        _, v = kit.as_pair(submission.call(task, accel, _T, _Q, _V, _H), 2)
        shares.append(float((v - _V)[0] / (_PUSH * _H)))
    return shares


def _weight(submission, task, h):
    """The sum of the weights with which position and velocity move, if it is one positive number."""
    q0, v0, g = np.array([0.2, -0.5, 1.3]), np.array([0.7, 0.1, -0.9]), 7.0
    _, v = kit.as_pair(submission.call(task, FreeFall(g), 0.4, q0, v0, h), 3)
    still, _ = kit.as_pair(submission.call(task, FreeFall(0.0), 0.4, q0, v0, h), 3)
    kick, drift = (v - v0)[2] / (-g * h), (still - q0) / (v0 * h)
    alike = np.allclose(v[:2], v0[:2], atol=1e-9) and np.allclose(drift, kick, rtol=1e-6)
    return float(kick) if alike and kick > 0 else None


def _calls(submission, task, value=0.0):
    """What accel is called with in a step where it has this value throughout."""
    accel = kit.counted(lambda *args, **names: np.full(2, value))
    kit.attempt(lambda: submission.call(task, accel, _T, _Q, _V, _H))
    return accel.calls


def _looks_elsewhere(submission, task):
    """Whether accel is called with a time before the step or after it, and with none inside."""
    times = [
        kit.attempt(lambda args=args: kit.as_number(args[0])) for args in _calls(submission, task) if args
    ]
    return bool(times) and not any(t is None or _T - 1e-9 <= t <= _T + _H + 1e-9 for t in times)


def _mixes_arguments(submission, task):
    """Whether accel gets a vector in the time's place, or the velocity in the position's."""
    # Without acceleration the velocity stays what it is in the whole step, and no position equals it.
    places = (
        [kit.attempt(lambda arg=arg: kit.as_vector(arg, 2)) for arg in call]
        for call in _calls(submission, task)
    )
    # A time for each coordinate, all the same, is a time.
    return any(
        len(place) == 3
        and (
            (place[0] is not None and not np.allclose(place[0], place[0][0]))
            or (place[1] is not None and np.allclose(place[1], _V))
        )
        for place in places
    )


def _remembers(submission, task):
    """Whether the same call gives something else after a call of another kind."""
    first = _generic(submission, task)
    submission.call(task, Oscillator(1.3), _T + 1.0, -_V, _Q, _H)
    return not _equal(first, _generic(submission, task))


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


def _equal(a, b):
    return all(np.allclose(x, y, rtol=1e-9, atol=1e-12, equal_nan=True) for x, y in zip(a, b, strict=True))


def _blind_spot(submission, task):
    """What the step does not look at: the clock, or the velocity, where only that acts."""
    calls = [[np.asarray(arg, dtype=float) for arg in call] for call in _calls(submission, task, 1.7)]
    # Where one acceleration is used for all, it is not the clock that is left out.
    if ORDERS[task] == 1 or all(np.array_equal(call[1], calls[0][1]) for call in calls):
        return None
    clock = DrivenPendulum(0.0, 0.0, 1.9, 2.3)
    _, v = kit.as_pair(submission.call(task, clock, _T, _Q, _V, _H), 2)
    if np.allclose(v, _V + _H * clock(_T, _Q, _V), rtol=1e-9) and all(call[0] == _T for call in calls):
        return "STAGE_TIMES_FROZEN"
    drag = DrivenPendulum(0.0, 0.7, 0.0, 1.0)
    _, v = kit.as_pair(submission.call(task, drag, _T, _Q, _V, _H), 2)
    blind = task == "rk4_step" and np.allclose(v, _V + _H * drag(_T, _Q, _V), rtol=1e-9)
    return "STAGE_VELOCITY_IGNORED" if blind and all(np.allclose(call[2], _V) for call in calls) else None


#: What ``accel`` returns at the first to the fourth call: nothing that the state would give. Four numbers
#: each, so that the velocities that come back show the method's table.
_SLOPES = np.array(
    [[1.3, -0.6, 0.2, 0.7], [-0.8, 0.9, 1.1, -0.3], [0.5, 1.7, -0.9, 0.4], [-1.1, -0.4, 0.6, 1.2]]
)


def _stage(submission, task):
    """Which of RK4's calls is the first that gets something else than in the classical method.

    Where all four are right, and the result is not, it is how they are put together.
    """
    if task != "rk4_step":
        return None
    accel = kit.counted(lambda *args, **names: _SLOPES[(len(accel.calls) - 1) % 4])
    q0, v0 = np.resize(_Q, 4), np.resize(_V, 4)
    end = kit.as_pair(submission.call(task, accel, _T, q0, v0, _H), 4)
    if accel.count != 4:
        return None
    if _weights_missed(accel.calls, end, q0, v0):
        return "STAGES_WEIGHED_WRONG"
    dv = np.zeros(4), _H / 2 * _SLOPES[0], _H / 2 * _SLOPES[1], _H * _SLOPES[2]
    v = [v0 + one for one in dv]
    q = q0, q0 + _H / 2 * v[0], q0 + _H / 2 * v[1], q0 + _H * v[2]
    t = _T, _T + _H / 2, _T + _H / 2, _T + _H
    for call, right, code in zip(accel.calls, zip(t, q, v, strict=True), _STAGES, strict=True):
        # Single precision is told by its digits.
        if len(call) != 3 or not all(map(functools.partial(np.allclose, rtol=1e-5), call, right)):
            return code
    weights = np.array([1, 2, 2, 1]) * _H / 6
    states = np.stack([q0 + weights @ np.array(v), v0 + weights @ _SLOPES])
    return None if np.allclose(end, states, rtol=1e-5) else "STAGES_PUT_TOGETHER_WRONG"


def _weights_missed(calls, end, q0, v0):
    """Whether the calls are another method's of order four, and the state after them is not its own."""
    if any(len(call) != 3 or np.shape(call[2]) != np.shape(v0) for call in calls):
        return False
    v = np.array([call[2] for call in calls])
    table, c = (v - v0) / _H @ np.linalg.inv(_SLOPES), np.array([(call[0] - _T) / _H for call in calls])
    if np.max(np.abs(table[1] - [0.5, 0, 0, 0])) + np.max(np.abs(table[2] - [0, 0.5, 0, 0])) < 1e-6:
        return False  # the classical method's own calls are told of elsewhere
    if not np.allclose(np.array([call[1] for call in calls]), q0 + _H * table @ v, rtol=1e-5):
        return False
    once, squared = table @ c, table @ c**2
    conditions = np.stack([c**0, c, c**2, c**3, once, c * once, squared, table @ once])
    wanted = 1 / np.array([1, 2, 3, 4, 6, 8, 12, 24])
    weights = np.linalg.lstsq(conditions, wanted)[0]
    if np.max(np.abs(conditions @ weights - wanted)) > 1e-6:
        return False
    own = q0 + _H * weights @ v, v0 + _H * weights @ _SLOPES
    return not np.allclose(end, own, rtol=1e-5)


#: The first call has no stage before it: what it gets is told by other probes.
_STAGES = None, "SECOND_STAGE_ELSEWHERE", "THIRD_STAGE_ELSEWHERE", "FOURTH_STAGE_ELSEWHERE"


def _digits(submission, task):
    """Whether a step is right to seven digits and no further: float32 keeps as many."""
    found = np.concatenate(_generic(submission, task))
    for stepper in _STEPPERS[task]:
        end = stepper.advance(_problem(task), State.of(_Q, _V, _T), _H)
        off = abs(found - np.concatenate([end.q, end.v])).max()
        if 1e-12 < off < 1e-6:
            return "FEW_DIGITS"
    return None


def of_halves(q_next, v_next, expected):
    """Which half of the state after a step is wrong, where the other is right. expected: both."""
    q_right, v_right = (
        np.allclose(actual, true, rtol=1e-9) for actual, true in zip((q_next, v_next), expected, strict=True)
    )
    if q_right == v_right:
        return None
    return named("VELOCITY_ALONE_WRONG" if q_right else "POSITION_ALONE_WRONG")


def of_order_measured(submission, task, hs, errors, run):
    """Like ``of_step``; where the formula is not recognised, by how these errors fall with these steps."""
    found = kit.attempt(lambda: of_step(submission, task, run))
    code = None if found else _rate(task, hs, errors)
    return named(code) if code else found


def _rate(task, hs, errors):
    """Whether smaller steps help as much as they should."""
    hs, errors = np.asarray(hs), np.asarray(errors)
    if not np.all(np.isfinite(errors)):
        return None
    if errors[-1] > 0.5 * errors[0]:
        return "DOES_NOT_CONVERGE"
    with np.errstate(divide="ignore", invalid="ignore"):
        slopes = np.diff(np.log(errors)) / np.diff(np.log(hs)) if errors[-1] > 0 else np.array([math.inf])
    # Of 98 known programs with too low an order, both slopes are 0.92 or more, and alike to 5 %. Errors that
    # rise and fall by chance are not.
    steady = slopes.min() > 0.8 and slopes.max() < 1.2 * slopes.min()
    return "ORDER_TOO_LOW" if steady and slopes[-1] < ORDERS[task] - 0.4 else None


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

IDENTITY = LinearStep([1.0], [0.0], [0.0], [1.0])
#: Durations (s) and steps (s) without any rounding, with the number of steps.
_PLAIN = ((1.0, 0.25, 4), (2.0, 0.5, 4))


def of_count(submission, n, h, q):
    """Why the number of times is wrong: alone, or as the number of samples is where nothing is rounded.

    n, h: number and size, s, of the steps of which it is wrong; q: what came as the positions.
    """
    if kit.attempt(lambda: kit.as_array(q, (n + 1, None), "q")) is not None:
        return named("TIMES_NOT_AS_ROWS")
    rows = []
    for t_end, size, count in _PLAIN:
        t, _, _ = kit.as_tuple(
            submission.call("integrate", IDENTITY, Oscillator(1.0), [1.0], [0.0], t_end, size), "tqv"
        )
        rows.append(len(kit.as_vector(t)) - count - 1)
    if rows[0] == rows[1] and abs(rows[0]) == 1:
        return named("OFF_BY_ONE_SAMPLE")
    exact = (2**20 * h).is_integer()
    return named("COUNT_NOT_ROUNDED") if rows == [0, 0] and n and not exact else None


def of_refusal(submission, q0, v0, t_end):
    """Why a duration of a whole number of steps gives a ValueError, if not every duration does."""
    plain = kit.attempt(lambda: submission.call("integrate", IDENTITY, Oscillator(1.0), q0, v0, 2.0, 0.5))
    if plain is None:
        return None
    return named("REFUSES_DIVISIBLE" if t_end else "REFUSES_NO_DURATION")


def of_acceptance(submission, q0, v0):
    """Which durations are refused, where one that is no whole number of steps is not."""
    refused = [
        kit.attempt(lambda x=x: submission.call("integrate", IDENTITY, Oscillator(1.0), q0, v0, x, 0.25))
        is None
        for x in (0.9, 1.1)
    ]
    if any(refused):
        return named("DURATION_LIMIT_TOO_WIDE" if all(refused) else "DURATION_CHECKED_ON_ONE_SIDE")
    return named("DURATION_NOT_CHECKED")


def of_whole_start(submission, args):
    """Why integrate fails on whole numbers, if it does not fail on the same numbers as floats."""
    step, accel, q0, v0, *rest = args
    floats = step, accel, q0.astype(float), v0.astype(float), *rest
    works = kit.attempt(lambda: submission.call("integrate", *floats)) is not None
    return named("INTEGER_STATE") if works else None


def of_whole_rows(submission, args, q):
    """What positions show that are whole numbers throughout, where true ones are not."""
    step, accel, q0, v0, *rest = args
    _, same, _ = kit.as_tuple(
        submission.call("integrate", step, accel, q0.astype(float), v0.astype(float), *rest), "tqv"
    )
    stands = np.array_equal(q, np.broadcast_to(q[0], q.shape))
    return None if stands or np.array_equal(kit.as_array(same, q.shape), q) else named("INTEGER_STATE")


def of_rows(t, q, v, h, states):
    """What is wrong with rows of the right number. ``states``: true q and v of every sample, (N+1, d)."""
    code = (
        _histories(q, v, states)
        or _first_row(t, q, v, h, states)
        or _later_rows(q, v, states)
        or _few_digits(q, v, states)
    )
    return named(code) if code else None


def _few_digits(q, v, states):
    """Whether all rows are right to six digits, and some no further: float32 keeps seven."""
    off = [abs(rows - true).max() / abs(true).max() for rows, true in zip((q, v), states, strict=True)]
    return "ROWS_HAVE_FEW_DIGITS" if 1e-9 < max(off) < 1e-6 else None


def _histories(q, v, states):
    """What is wrong with the two arrays, whatever the step did."""
    q_true, v_true = states
    if np.allclose(q, v_true) and np.allclose(v, q_true):
        return "HISTORIES_SWAPPED"
    if np.array_equal(q, v) and np.any(q) and not np.allclose(q_true, v_true):
        return "HISTORIES_IDENTICAL"
    whole = [
        np.array_equal(a, np.trunc(a)) and np.array_equal(a[0], np.trunc(b[0]))
        for a, b in ((q, q_true), (v, v_true))
    ]
    # Positions that are all zero may have been left out as well as cut off.
    moves = [not np.array_equal(a, np.broadcast_to(a[0], a.shape)) for a in (q, v)]
    seen = whole[0] and (whole[1] or np.any(q)) and (moves[0] or (whole[1] and moves[1]))
    if not seen or np.array_equal(q_true, np.trunc(q_true)):
        return None
    # From whole numbers the first step is right but for its fractions.
    from_whole = all(np.array_equal(true[0], np.trunc(true[0])) for true in states)
    return None if from_whole and not np.array_equal(q[1], np.trunc(q_true[1])) else "INTEGER_STATE"


def _first_row(t, q, v, h, states):
    """What the first row is, if not the initial state at time 0."""
    late = len(t) > 1 and np.allclose(t, h * np.arange(1, len(t) + 1))
    pairs = list(zip((q, v), states, strict=True))
    if (
        len(q) > 2
        and np.any(q)
        and all(np.array_equal(rows, np.broadcast_to(rows[-1], rows.shape)) for rows in (q, v))
        and not np.allclose(q[0], states[0][0])
    ):
        return "ROWS_ALL_THE_SAME"
    if all(np.allclose(rows[0], true[0]) for rows, true in pairs):
        return "TIMES_START_LATE" if late else None
    after = len(q) > 1 and all(np.allclose(rows[0], true[1]) for rows, true in pairs)
    empty = all(np.allclose(rows[0], true[0]) or not np.any(rows[0]) for rows, true in pairs)
    return "INITIAL_STATE_MISSING" if after or empty else "INITIAL_STATE_WRONG"


def _empty_row(q, v, q_true):
    """Whether the last row holds zeros alone, after right ones, or the second one does."""
    if np.allclose(q[:-1], q_true[:-1]) and not np.any(q[-1]) and not np.any(v[-1]):
        return "LAST_STEP_MISSING"
    second = len(q) > 2 and np.any(q_true[1]) and not np.any(q[1]) and not np.any(v[1])
    return "FIRST_STEP_MISSING" if second else None


def _later_rows(q, v, states):
    """What is wrong after a right first row."""
    if empty := _empty_row(q, v, states[0]):
        return empty
    first = [np.allclose(rows[1], true[1]) for rows, true in zip((q, v), states, strict=True) if len(q) > 1]
    if len(q) > 1 and np.allclose(q[1], states[1][1]) and np.allclose(v[1], states[0][1]) and not all(first):
        return "STEP_RESULT_SWAPPED"
    if any(first) and not all(first):
        return "ROW_OF_V_WRONG" if first[0] else "ROW_OF_Q_WRONG"
    if len(q) <= 2 or not (np.allclose(q[2:], q[1]) and np.allclose(v[2:], v[1])):
        return None
    if all(first):
        return "STATE_NOT_CARRIED"
    return "PATH_STANDS_STILL" if np.allclose(q[1], q[0]) and np.allclose(v[1], v[0]) else None


def of_times(submission, times, h):
    """What is wrong with the times that ``integrate`` told its step. times: shape (N,), s.

    They are read off a path, so where a path without a clock is wrong, that is told.
    """
    n, size, p = 6, 0.25, np.array([[0.9, 0.35], [-0.4, 0.85]])
    turn = LinearStep(*p.reshape(4, 1).tolist())
    start = np.array([1.0, -0.5]), np.array([0.5, 2.0])
    found = submission.call("integrate", turn, Oscillator(1.0), *start, n * size, size)
    t, q, v = kit.as_tuple(found, ("t", "q", "v"))
    t, q, v = kit.as_vector(t), kit.as_array(q, (n + 1, 2)), kit.as_array(v, (n + 1, 2))
    true = np.array([np.linalg.matrix_power(p, i) @ start for i in range(n + 1)])
    if not np.allclose(np.stack([q, v], axis=1), true, rtol=1e-9, atol=1e-12):
        return of_rows(t, q, v, size, (true[:, 0], true[:, 1]))
    if np.allclose(times, times[0]):
        return named("TIME_NOT_PASSED" if _time_stands(submission) else "LOOP_ENDS_AT_REST")
    if np.allclose(times, h * np.arange(1, len(times) + 1)):
        return named("TIME_AHEAD")
    exact = h * np.arange(len(times))
    rounded = any(  # by Python or by numpy, which differ in a tie
        np.allclose(times, np.round(times, digits), rtol=0, atol=2e-6)
        and np.all(np.abs(times - exact) < 0.51 * 10.0**-digits)
        for digits in (2, 3, 4)
    )
    return named("TIMES_ROUNDED") if rounded else None


def _time_stands(submission):
    """Whether a step is told the same time again where its velocity changes in every step, too."""
    flips = LinearStep([1.0], [0.0], [0.0], [-1.0], clock=2.0)
    start = np.array([1.0]), np.array([0.5])
    found = submission.call("integrate", flips, Oscillator(1.0), *start, 1.5, 0.25)
    return np.allclose(np.diff(kit.as_tuple(found, ("t", "q", "v"))[1][:, 0], 2), 0)


# -- observed_order -----------------------------------------------------------------------------------


def of_order(submission, value, hs, errors):
    """What a wrong slope through (hs, errors) has in common with others."""
    value = kit.as_number(value)
    if not math.isfinite(value):
        return None
    right = convergence_order(hs, errors)
    if value < 0 < right:
        pairings = ((hs, errors[::-1]), (np.sort(hs), np.sort(errors)[::-1]))
        flipped = (-right, *(convergence_order(*pairing) for pairing in pairings))
        alike = any(math.isclose(value, one, rel_tol=1e-6) for one in flipped)
        # The sign of what is nearly nothing, or divided by it, is chance; so is that of a part of scattered
        # points.
        shrinks = np.all(np.diff(np.asarray(errors)[np.argsort(hs)]) > 0)
        tells = 1e-3 < -value < 100.0 and shrinks
        code = "ORDER_SIGN_FLIPPED" if alike else "ORDER_NEGATIVE" if tells else None
        return named(code) if code else None
    by_error, by_step = dict(zip(errors, hs, strict=True)), dict(zip(hs, errors, strict=True))
    for code, steps, left in (
        ("EQUAL_ERRORS_LOST", [*by_error.values()], [*by_error]),
        ("EQUAL_STEPS_LOST", [*by_step], [*by_step.values()]),
    ):
        if 1 < len(left) < len(hs) and math.isclose(value, convergence_order(steps, left), abs_tol=1e-8):
            return named(code)
    if right < -1e-3 and (value == 0 or math.isclose(value, -right, rel_tol=1e-6)):
        return named("SLOPE_WITHOUT_SIGN" if value else "SLOPE_CUT_AT_ZERO")
    if _rounds(submission):
        return named("ORDER_ROUNDED")
    # Where the points lie on one line, any way of fitting would find its slope.
    on_a_line = np.ptp(np.log(errors) - right * np.log(hs)) < 1e-9
    near = on_a_line and math.isclose(value, right, rel_tol=1e-3)
    return named("SLOPE_NEARLY_RIGHT") if near else None


def _rounds(submission):
    """Whether slopes of many digits come out with few of them, all rounded or cut in the same place."""
    hs, slopes = np.array([0.3, 0.11, 0.05]), (1.41421356237, 3.61803398875, 6.43210987654)
    values = submission.call_each("observed_order", [(hs, 2.0 * hs**slope) for slope in slopes])
    found = np.array([float(kit.as_number(value)) for value in values])
    near = (np.all(found == np.round(found, k)) and np.all(abs(found - slopes) < 10.0**-k) for k in range(9))
    return any(near)


# -- max_stable_step ----------------------------------------------------------------------------------

#: Maps whose limits differ: one with an eigenvalue of -1 at z = 1.5, one that spirals out at 1.9.
_FLIPPED = LinearStep([0.6, 0, -1.6 / 1.5**2], [2.0], [0.0], [0.3])
_SPIRAL = LinearStep([0.3, 0, 0.02], [0.75, 0, 0.05], [-0.75, 0, -0.05], [0.3, 0, 0.02])
#: Diagonal, and stable for longer, whatever is looked at: its entries, a norm or its eigenvalues.
_LONG = LinearStep([0.1, 0.15], [0.0], [0.0], [0.2])


def of_stability(submission, value, step, omega, limit):
    """What a wrong largest step shows. limit: the right h * omega."""
    z = kit.as_number(value) * omega
    if z == math.inf and limit < math.inf:
        return named("LIMIT_NEVER_SEEN")
    flipped, spiral = (
        kit.as_number(submission.call("max_stable_step", other, 1.0)) for other in (_FLIPPED, _SPIRAL)
    )
    # Drawn numbers may make h * omega look like h: another map at another omega decides.
    if _same(kit.as_number(submission.call("max_stable_step", _FLIPPED, 4.0)), 1.5) and _same(
        z, limit * omega
    ):
        return named("RETURNS_Z")
    # A search that takes no notice of the step: a strict one, too, may find two maps unstable at once.
    if 0.0 < flipped < math.inf and _same(flipped, spiral):
        third = kit.as_number(submission.call("max_stable_step", _LONG, 1.0))
        if _same(flipped, third):
            return named("ASSUMES_ITS_LIMIT")
    code = _beside(z, limit) if z != limit else None
    if code == "LIMIT_TOO_EARLY" and _too_strict(submission, z, step, omega):
        code = "TOLERANCE_TOO_TIGHT"
    return named(code) if code else None


def _too_strict(submission, z, step, omega):
    """Whether a search that is right for two other maps ends where this map's radius is about one."""
    radius = max(abs(np.linalg.eigvals(step.matrix(1.01 * z + 0.05))))
    if z > 1.4 or abs(radius - 1) > 1e-9:
        return False
    values = submission.call_each("max_stable_step", [(_FLIPPED, omega), (_SPIRAL, omega)])
    return all(_same(kit.as_number(one) * omega, z) for one, z in zip(values, (1.5, 1.9), strict=True))


def _beside(z, limit):
    """On which side of the right one a limit lies, and how far."""
    if limit == 0.0:
        return "NO_ZERO" if z > 0.0 else None
    if limit == math.inf:
        return "LIMIT_TOO_EARLY" if 0.0 <= z <= 2.0 else "NO_INFINITY"
    if math.isnan(z):
        return None
    # As far as a search in the increments of the README may be off.
    if abs(z - limit) < min(0.25, 0.5 * limit):
        return "SEARCH_TOO_COARSE"
    return "LIMIT_TOO_LATE" if z > limit else "LIMIT_TOO_EARLY"


def _same(a, b):
    return a == b or (math.isfinite(a) and math.isclose(a, b, rel_tol=0.02))
