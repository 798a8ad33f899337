"""What a failed check of ``collisions`` shows of the mistake behind it.

Each probe looks for a property that a family of mistakes has: which law is broken, where a nan comes from,
when a path bends and how fast it goes on. Which known program it is, ``hypotheses.json`` tells; a probe
speaks where none of them fits.
"""

from __future__ import annotations

import math

import numpy as np

from course.grading import kit

named = kit.words("collisions")

#: What restitution may have become, as a share of the speed of approach.
_PARTINGS = (
    ("RESTITUTION_SQUARED", lambda e: e * e),
    ("RESTITUTION_AS_ENERGY", math.sqrt),
    ("RESTITUTION_IGNORED", lambda e: 1.0),
    ("RESTITUTION_IGNORED", lambda e: 0.0),
    ("ONLY_THE_REBOUND", lambda e: e - 1),
    ("RESTITUTION_SIGN_FLIPPED", lambda e: -e),
)

# -- single calls ---------------------------------------------------------------------------------------


@np.errstate(all="ignore")
def of_calls(task, calls, values, truth):
    """What the answers of a task to ``calls`` show, beside the right ones (``truth``); or None."""
    code = _not_a_number(task, calls, values, truth)
    if not code and not all(map(_same, truth, values)):
        code = (
            _moment(task, calls, values, truth)
            or _unmoved(task, calls, values)
            or _by_law(task, calls, values, truth)
        )
    return named(code) if code else None


def _not_a_number(task, calls, values, truth):
    """Where nan comes from: coinciding centres, infinite masses, no slip, no relative motion."""
    spoiled = [call for call, value in zip(calls, values, strict=True) if _has_nan(value)]
    if not spoiled:
        return None
    if task == "detect_sphere_sphere":
        return "NORMAL_UNDEFINED"
    if task == "time_of_impact":
        return _moment_not_a_number(calls, values, truth)
    if task in ("impulse_1d", "resolve", "resolve_with_friction"):
        if all(math.inf in call[:2] for call in spoiled):
            return "INFINITE_MASS_NAN"
        if task == "resolve_with_friction":
            return "NO_SLIDING_NAN"
    return None


def _moment_not_a_number(calls, values, truth):
    """Which division or root gives nan, if nan is what is wrong with the first answer that is."""
    for call, value, right in zip(calls, values, truth, strict=True):
        if _has_nan(value):
            return "NO_RELATIVE_MOTION" if np.array_equal(call[1], call[4]) else "ROOT_OF_A_NEGATIVE"
        if not _same(right, value):
            return None
    return None


def _has_nan(value):
    if isinstance(value, list | tuple):
        return any(map(_has_nan, value))
    return isinstance(value, float | np.ndarray) and bool(np.any(np.isnan(value)))


def _same(wanted, value):
    if wanted is None or isinstance(wanted, bool | np.bool_):
        return value is None if wanted is None else value is bool(wanted)
    if isinstance(wanted, tuple):
        return (
            isinstance(value, list | tuple) and len(value) == len(wanted) and all(map(_same, wanted, value))
        )
    try:
        found = np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        return False
    return found.shape == np.shape(wanted) and np.allclose(found, wanted, rtol=1e-9, atol=1e-10)


def _unmoved(task, calls, values):
    """Whether bodies that run into each other keep their velocities, in two cases at least."""
    if task != "impulse_1d" and not task.startswith("resolve"):
        return None
    colliding = [(call, value) for call, value in zip(calls, values, strict=True) if _closing(task, call) > 0]
    if task == "impulse_1d":
        kept = [value == 0 for _, value in colliding]
    else:
        kept = [_same((call[2], call[3]), value) for call, value in colliding]
    return "NO_RESPONSE" if len(kept) > 1 and all(kept) else None


def _by_law(task, calls, values, truth):
    """Which law is broken."""
    if task == "time_of_impact":
        return _coarse(calls, values, truth)
    if task.startswith("detect"):
        return None
    colliding = [pair for pair in zip(calls, values, strict=True) if _closing(task, pair[0]) > 0]
    if task != "impulse_1d":
        finite = [(c, v) for c, v in colliding if math.inf not in c[:2]]
        if any(energy(*c[:2], *v) > energy(*c[:4]) * (1 + 1e-9) for c, v in finite):
            return "ENERGY_CREATED"
        if any(_momentum_lost(c, v) for c, v in finite):
            return "MOMENTUM_LOST"
    excess = np.array([_excess(task, c, v) for c, v in colliding])
    if np.all(excess > 1e-8):
        return "BLOW_TOO_STRONG"
    return "BLOW_TOO_WEAK" if np.all(excess < -1e-8) else None


def _closing(task, call):
    """Speed of approach, m/s."""
    apart = call[2] - call[3]
    return apart if task == "impulse_1d" else float(apart @ call[4])


def _excess(task, call, value):
    """By how much the speed of parting exceeds e times that of approach, m/s."""
    closing = _closing(task, call)
    if task == "impulse_1d":
        parting = value * (1 / call[0] + 1 / call[1]) - closing
    else:
        parting = float((np.asarray(value[1], float) - np.asarray(value[0], float)) @ call[4])
    return parting - call[4 if task == "impulse_1d" else 5] * closing


def _momentum_lost(call, value):
    off = momentum(*call[:2], *value) - momentum(*call[:4])
    return np.abs(off).max() > 1e-8 * (1 + momentum(*call[:2], *map(np.abs, call[2:4])).max())


def _moment(task, calls, values, truth):
    """With a time of impact: the mistake that spoils the first answer that is wrong."""
    if task != "time_of_impact":
        return None
    if all(value is None for value in values):
        return "NEVER_FINDS_A_CONTACT"
    misses = [value for value, right in zip(values, truth, strict=True) if right is None]
    if len(misses) > 1 and misses[0] is not None and all(value == misses[0] for value in misses):
        return "MISS_IS_A_NUMBER"
    for call, value, right in zip(calls, values, truth, strict=True):
        if value is None or _same(right, value):
            continue
        if right is None:
            # Only a time at which they do touch is a contact that was, or one that is to come.
            touches = _apart(call, value) < 1e-6
            return ("IMPACT_IN_THE_PAST" if value < 0.0 else _beyond(call, value)) if touches else None
        # The other root of the quadratic lies as far beyond the closest approach as this one before it.
        dx, dv = call[3] - call[0], call[4] - call[1]
        late = -2 * float(dx @ dv) / float(dv @ dv) - right
        return "TIME_OF_IMPACT_LATE_ROOT" if right > 0.0 and _same(late, value) else None
    return None


def _beyond(call, value):
    return "IMPACT_BEYOND_STEP" if value > call[-1] else None


def _apart(call, t):
    """By how much the surfaces of two spheres are apart, or overlap, at time t, as a share of the radii."""
    xa, va, ra, xb, vb, rb, _ = call
    x = xb - xa + t * (vb - va)
    return abs(float(np.sqrt(x @ x)) - ra - rb) / (ra + rb)


def _coarse(calls, values, truth):
    """Contacts that are missed, or found at about the right time."""
    pairs = [(right, value, call[-1]) for call, value, right in zip(calls, values, truth, strict=True)]
    if any(right is None and value is not None for right, value, _ in pairs):
        return (
            "CONTACTS_MISSED"
            if any(value is None and right is not None for right, value, _ in pairs)
            else None
        )
    found = [pair for pair in pairs if None not in pair]
    near = all(abs(value - right) <= 0.05 * dt for right, value, dt in found)
    if len(found) == sum(right is not None for right, _, _ in pairs):
        return "MOMENT_TOO_COARSE" if near else None
    # A search in steps finds the others a little late.
    late = all(value >= right - 1e-9 for right, value, _ in found)
    rough = not all(_same(right, value) for right, value, _ in found)
    return "TUNNELS" if near and late and rough else "CONTACTS_MISSED"


@np.errstate(all="ignore")
def momentum(ma, mb, va, vb):
    """Total momentum, kg m/s."""
    return ma * np.asarray(va, dtype=float) + mb * np.asarray(vb, dtype=float)


@np.errstate(all="ignore")
def energy(ma, mb, va, vb):
    """Total kinetic energy, J."""
    return 0.5 * (ma * float(np.dot(va, va)) + mb * float(np.dot(vb, vb)))


# -- the head-on simulation -----------------------------------------------------------------------------


@np.errstate(all="ignore")
def of_head_on(scene, truth, t, x, v, h):
    """What a head-on path of the right length does instead. truth: ``paths.Meeting``; x, v: shape (n, 2)."""
    if np.isnan(x).any() or np.isnan(v).any():
        return named("INFINITE_MASS_NAN") if math.inf in scene.m else None
    if not np.allclose(x[0], scene.x0, atol=1e-9) or not np.allclose(v[0], scene.v0, atol=1e-9):
        return named("INITIAL_STATE_MISSING")
    straight, _ = scene.at(t, math.inf, None)
    if np.allclose(x, straight, atol=1e-9) and truth.contact < t[-1]:
        met = np.any(np.abs(straight[:, 1] - straight[:, 0]) <= 2 * scene.radius)
        if truth.contact < h:
            return named("FIRST_STEP_MISSED")  # scenes that meet later come before, and were right
        return named("PASSES_THROUGH" if met else "TUNNELS")
    if truth.contact == math.inf:  # they part from the start
        return named("IMPULSE_ON_SEPARATING") if np.any(v != v[0]) else None
    code = _of_wait(scene, truth, t, x, h)
    if not code and not np.allclose(v[-1], truth.after, atol=1e-8):
        code = _of_speeds(scene, v)
    elif not code:
        code = _of_timing(truth, v, h)
    return named(code) if code else None


def _of_wait(scene, truth, t, x, h):
    """Whether all is right but that the bodies stand still after the impact until the next sample."""
    lost = math.ceil(truth.contact / h - 1e-9) * h - truth.contact
    for wait in (lost, lost + h):  # a whole step where the contact falls on a sample
        # Where the impact itself falls on a sample, the two sides of it are a matter of taste.
        away = np.abs(t - truth.contact) > 1e-9
        path = scene.at(t, truth.contact, truth.after, wait)[0]
        if wait > 1e-9 and np.allclose(x[away], path[away], rtol=1e-9, atol=1e-8):
            return "REST_OF_STEP_LOST"
    return None


def _of_speeds(scene, v):
    """The velocities at the end are wrong ones: which?"""
    impacts = np.flatnonzero(np.any(np.abs(np.diff(v, axis=0)) > 1e-9, axis=1))
    if len(impacts) > 1 and v[impacts[1], 0] <= v[impacts[1], 1]:  # the second one while they move apart
        return "IMPULSE_ON_SEPARATING"
    if math.inf in scene.m:
        return None
    kept = abs(float(np.dot(scene.m, v[-1] - scene.v0))) < 1e-8 * float(np.dot(scene.m, np.abs(scene.v0)))
    if kept:
        parting = (v[-1, 1] - v[-1, 0]) / (scene.v0[0] - scene.v0[1])
        same = (
            c
            for c, becomes in _PARTINGS
            if math.isclose(parting, becomes(scene.restitution), rel_tol=1e-8, abs_tol=1e-9)
        )
        codes = set(same)
        if len(codes) == 1:  # where e is 0 or 1, several look alike
            return codes.pop()
    if energy(*scene.m, *v[-1]) > energy(*scene.m, *scene.v0) * (1 + 1e-9):
        return "ENERGY_CREATED"
    return None if kept else "MOMENTUM_LOST"


def _of_timing(truth, v, h):
    """The velocities are right in the end: does the impact come at a sample?"""
    colliding = np.flatnonzero(np.any(np.abs(np.diff(v, axis=0)) > 1e-9, axis=1))
    late = len(colliding) and (colliding[0] + 1) * h >= truth.contact - 1e-9
    return "IMPACT_AT_SAMPLE" if late else None


# -- the drop -------------------------------------------------------------------------------------------


@np.errstate(all="ignore")
def of_drop(scene, truth, t, z, v, h):
    """What a path of the right length does instead. truth: ``paths.Bounces``; z, v: shape (n,)."""
    if not np.all(np.isfinite(z)) or not np.all(np.isfinite(v)):
        return None
    if not math.isclose(z[0], scene.z0, abs_tol=1e-9) or not math.isclose(v[0], scene.v0, abs_tol=1e-9):
        return named("INITIAL_STATE_MISSING")
    before = t < (truth.times[0] if truth.times else math.inf)
    fall = scene.z0 + scene.v0 * t - scene.g * t * t / 2
    off = z - fall
    if before.sum() > 2 and not np.allclose(off[before], 0.0, atol=1e-8):
        if scene.v0 > 0 and scene.z0 == scene.radius and np.all(z[before] <= scene.radius + 1e-9):
            return named("LAUNCH_IGNORED")
        drift = np.abs(np.abs(off) - scene.g * h * t / 2)
        return named("EULER_IN_FLIGHT") if np.all(drift[before] < 1e-6) else None
    if np.allclose(z, fall, rtol=1e-9, atol=1e-8):
        return named("PASSES_THROUGH")
    code = (
        _drop_rebound(scene, truth, t, z, v)
        or _drop_end(scene, truth, t, z, v)
        or _drop_impact(scene, truth, t, z, v)
    )
    return named(code) if code else None


def _drop_rebound(scene, truth, t, z, v):
    """The share of its speed with which the ball leaves its first contact, if that is a known wrong one."""
    if len(truth.times) < 1 or not truth.speeds[0]:
        return None
    speed = truth.speeds[0]
    k = int(np.searchsorted(t, truth.times[0]))
    if k >= len(t) or z[k] < scene.radius - 1e-9:
        return None
    rebound = math.sqrt(max(v[k] ** 2 + 2 * scene.g * (z[k] - scene.radius), 0.0)) / scene.fastest
    if math.isclose(rebound * scene.fastest, speed, rel_tol=1e-8):
        return None
    e = scene.restitution
    names = (code for code, becomes in _PARTINGS[:3] if math.isclose(rebound, becomes(e), rel_tol=1e-8))
    return next(names, None)


def _drop_end(scene, truth, t, z, v):
    """How it ends, if it goes right until it may rest."""
    path = scene.at(t, truth.times, truth.speeds)[0]
    wrong = np.flatnonzero(np.abs(z - path) > 1e-8)
    rests = np.abs(z - scene.radius) < 1e-9
    if len(wrong) and t[wrong[0]] < truth.may:
        still = rests[wrong[0] :].all() and np.all(v[wrong[0] :] == 0.0)
        return "RESTS_TOO_EARLY" if still else None
    late = t > truth.must
    if not late.any():
        return None
    if np.any(z[late] < scene.radius - 1e-9) and z[-1] < scene.radius - 1e-6:
        return "SINKS_THROUGH_FLOOR"
    return "RESTING_JITTER" if np.any(~rests[late]) or np.any(v[late] != 0.0) else None


def _drop_impact(scene, truth, t, z, v):
    """What happens around the first contact, if the flight before it is right."""
    if not truth.times:
        return None
    k = int(np.searchsorted(t, truth.times[0]))  # the first sample at or after the contact
    if k >= len(t):
        return None
    stuck = math.isclose(z[k], scene.radius, abs_tol=1e-9)
    if stuck and abs(v[k] - truth.speeds[0]) < 1e-8:
        return "REST_OF_STEP_LOST"
    total = scene.g * z + v * v / 2
    start = scene.g * scene.z0 + scene.v0**2 / 2
    if np.any(v[k : k + 2] < 0.0) or stuck or z[k] < scene.radius - 1e-9:
        grown = np.max(total) > start * (1 + 1e-6)
        return "ENERGY_CREATED" if grown else "IMPACT_AT_SAMPLE"
    return "ENERGY_CREATED" if np.max(total) > start * (1 + 1e-6) else None


# -- samples --------------------------------------------------------------------------------------------


def of_count(rows, t_end, h, t=()):
    """What gives ``rows`` samples for a duration. t: the times that came with them, in any form."""
    exact = t_end / h
    if rows and _same(h, t[0] if len(t) else None):
        return named("INITIAL_STATE_MISSING")
    if rows == round(exact) + 1:
        return None
    if rows == int(exact) + 1:
        return named("TRUNCATED_STEP_COUNT")
    by_one = abs(rows - round(exact) - 1) == 1 or rows == int(exact)
    return named("OFF_BY_ONE_SAMPLE") if by_one else None


def of_times(t, h):
    """What is wrong with times of the right number."""
    if len(t) > 1 and math.isclose(t[0], h):
        return named("INITIAL_STATE_MISSING")
    return named("TIME_ACCUMULATES") if np.allclose(t, h * np.arange(len(t)), atol=1e-5 * h) else None
