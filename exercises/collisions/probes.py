"""Finding out which mistake a failed check looks like, for the exercise ``collisions``.

Answers to a batch of calls are compared with what the wrong formulas of ``formulas.py`` give for the same
arguments: the one that explains every answer is named. Nothing is called again. Paths of the two simulations
are recognised by what they do: when they bend, how fast they go on, and how they end.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from course.grading import kit

_diagnosis = kit.companion("collisions", "diagnosis")
_formulas = kit.companion("collisions", "formulas")
_paths = kit.companion("collisions", "paths")
named = _diagnosis.named
RIGHT, WRONG = _formulas.RIGHT, _formulas.WRONG

# -- single calls ---------------------------------------------------------------------------------------


@np.errstate(all="ignore")
def of_calls(task, calls, values):
    """The mistake that explains what a task returned for each of ``calls``, or None."""
    special = _not_a_number(task, calls, values)
    if special:
        return named(special)
    if _all_agree(RIGHT[task], calls, values):
        return None
    if task == "time_of_impact" and all(value is None for value in values):
        return named("NEVER_FINDS_A_CONTACT")
    for code, wrong in WRONG[task]:
        if _all_agree(wrong, calls, values):
            return named(code)
    special = (
        _moment(task, calls, values)
        or _part(task, calls, values)
        or _unmoved(task, calls, values)
        or _by_law(task, calls, values)
    )
    return named(special) if special else None


def _part(task, calls, values):
    """With two mistakes in one answer: the formula that explains the first part that is wrong."""
    if not task.startswith("detect"):
        return None
    for part in (1, 2, 0):  # the normal, the depth, touching

        def agrees(formula, part=part):
            return all(_same(formula(*c)[part], v[part]) for c, v in zip(calls, values, strict=True))

        if not agrees(RIGHT[task]):
            return next((code for code, wrong in WRONG[task] if agrees(wrong)), None)
    return None


def _not_a_number(task, calls, values):
    """Where nan comes from: coinciding centres, infinite masses, no slip, no relative motion."""
    spoiled = [call for call, value in zip(calls, values, strict=True) if _has_nan(value)]
    if not spoiled:
        return None
    if task == "detect_sphere_sphere":
        return "NORMAL_UNDEFINED"
    if task == "time_of_impact":
        return _moment_not_a_number(calls, values)
    if task in ("impulse_1d", "resolve", "resolve_with_friction"):
        if all(math.inf in call[:2] for call in spoiled):
            return "INFINITE_MASS_NAN"
        if task == "resolve_with_friction":
            return "NO_SLIDING_NAN"
    return None


def _moment_not_a_number(calls, values):
    """Which division or root gives nan, if nan is what is wrong with the first answer that is."""
    for call, value in zip(calls, values, strict=True):
        if _has_nan(value):
            return "NO_RELATIVE_MOTION" if np.array_equal(call[1], call[4]) else "ROOT_OF_A_NEGATIVE"
        if not _agrees(RIGHT["time_of_impact"], call, value):
            return None
    return None


def _has_nan(value):
    if isinstance(value, list | tuple):
        return any(map(_has_nan, value))
    return isinstance(value, float | np.ndarray) and bool(np.any(np.isnan(value)))


def _all_agree(formula, calls, values):
    return all(_agrees(formula, call, value) for call, value in zip(calls, values, strict=True))


def _agrees(formula, call, value):
    try:
        return _same(formula(*call), value)
    except (ZeroDivisionError, ValueError, OverflowError):
        return False


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
    """Whether bodies that run into each other keep their velocities."""
    if task == "impulse_1d":
        return "NO_RESPONSE" if all(value == 0 for value in values) else None
    if not task.startswith("resolve"):
        return None
    kept = (_same((call[2], call[3]), value) for call, value in zip(calls, values, strict=True))
    return "NO_RESPONSE" if all(kept) else None


def _by_law(task, calls, values):
    """Which law is broken, where no formula is recognised."""
    if task == "time_of_impact":
        return _coarse(calls, values)
    if task.startswith("detect"):
        return None
    struck = [pair for pair in zip(calls, values, strict=True) if _closing(task, pair[0]) > 0]
    if task != "impulse_1d":
        finite = [(c, v) for c, v in struck if math.inf not in c[:2]]
        if any(energy(*c[:2], *v) > energy(*c[:4]) * (1 + 1e-9) for c, v in finite):
            return "ENERGY_CREATED"
        if any(_momentum_lost(c, v) for c, v in finite):
            return "MOMENTUM_LOST"
    excess = np.array([_excess(task, c, v) for c, v in struck])
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


def _moment(task, calls, values):
    """With several mistakes in a time of impact: the one that spoils the first answer that is wrong."""
    if task != "time_of_impact":
        return None
    for call, value in zip(calls, values, strict=True):
        right = RIGHT[task](*call)
        if value is None or _has_nan(value) or _same(right, value):
            continue
        if value < 0.0:
            return "IMPACT_IN_THE_PAST"
        if right is None:
            return "IMPACT_BEYOND_STEP" if value > call[-1] else None
        # The later root may lie beyond the step, where the formula of the mistake alone gives None.
        late = _formulas.later_root(*call)
        return "TIME_OF_IMPACT_LATE_ROOT" if _same(late, value) else None
    return None


def _coarse(calls, values):
    """Contacts that are missed, or found at about the right time."""
    pairs = [(RIGHT["time_of_impact"](*call), v, call[-1]) for call, v in zip(calls, values, strict=True)]
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
def of_head_on(scene, t, x, v, h):
    """What a head-on path of the right length does instead. x, v: shape (n, 2)."""
    if not np.allclose(x[0], scene.x0, atol=1e-9) or not np.allclose(v[0], scene.v0, atol=1e-9):
        return named("INITIAL_STATE_MISSING")
    straight, _ = scene.at(t, contact=math.inf)
    if np.allclose(x, straight, atol=1e-9) and scene.contact < t[-1]:
        met = np.any(np.abs(straight[:, 1] - straight[:, 0]) <= 2 * scene.radius)
        return named("PASSES_THROUGH" if met else "TUNNELS")
    if scene.contact == math.inf:  # they part from the start
        return named("IMPULSE_ON_SEPARATING") if np.any(v != v[0]) else None
    for code, contact, after, wait in _head_on_mistakes(scene, h):
        # Where the blow itself falls on a sample, the two sides of it are a matter of taste.
        away = np.abs(t - contact) > 1e-9
        path = scene.at(t, contact, after, wait)[0]
        if np.allclose(x[away], path[away], rtol=1e-9, atol=1e-8):
            return named(code)
    if not np.allclose(v[-1], scene.after(), atol=1e-8):
        return _of_speeds(scene, v)
    return _of_timing(scene, x, v, h)


def _head_on_mistakes(scene, h):
    """Code, time of contact, velocities after it, pause."""
    exact = scene.contact
    for code, factor in _formulas.FACTORS:
        yield code, exact, scene.after(factor=factor), 0.0
    for code, give in _formulas.GIVES:
        yield code, exact, scene.after(give=give), 0.0
    lost = math.ceil(exact / h - 1e-9) * h - exact
    yield "REST_OF_STEP_LOST", exact, None, lost
    yield "REST_OF_STEP_LOST", exact, None, lost + h  # where the contact falls on a sample
    room = scene.x0[1] - scene.x0[0]
    yield "RADIUS_IGNORED", room / scene.closing, None, 0.0
    yield "ONE_RADIUS_ONLY", (room - scene.radius) / scene.closing, None, 0.0


def _of_speeds(scene, v):
    """The velocities at the end are wrong ones: which?"""
    blows = np.flatnonzero(np.any(np.abs(np.diff(v, axis=0)) > 1e-9, axis=1))
    if len(blows) > 1 and v[blows[1], 0] <= v[blows[1], 1]:  # the second one while they move apart
        return named("IMPULSE_ON_SEPARATING")
    for code, factor in _formulas.FACTORS:
        if np.allclose(v[-1], scene.after(factor=factor), atol=1e-8):
            return named(code)
    for code, give in _formulas.GIVES:
        if np.allclose(v[-1], scene.after(give=give), atol=1e-8):
            return named(code)
    if np.isnan(v).any():
        return named("INFINITE_MASS_NAN") if math.inf in scene.m else None
    if math.inf not in scene.m and energy(*scene.m, *v[-1]) > energy(*scene.m, *scene.v0) * (1 + 1e-9):
        return named("ENERGY_CREATED")
    return named("IMPULSE_ON_SEPARATING") if len(blows) > 1 else None


def _of_timing(scene, x, v, h):
    """The velocities are right in the end: does the blow come at a sample?"""
    struck = np.flatnonzero(np.any(np.abs(np.diff(v, axis=0)) > 1e-9, axis=1))
    late = len(struck) and (struck[0] + 1) * h >= scene.contact - 1e-9
    return named("IMPACT_AT_SAMPLE") if late else None


# -- the drop -------------------------------------------------------------------------------------------


@np.errstate(all="ignore")
def of_drop(scene, t, z, v, h):
    """What a path of the right length does instead. z, v: shape (n,)."""
    if not math.isclose(z[0], scene.z0, abs_tol=1e-9) or not math.isclose(v[0], scene.v0, abs_tol=1e-9):
        return named("INITIAL_STATE_MISSING")
    first = scene.contacts(t[-1], scene.g * h)[0]
    before = t < (first[0] if len(first) else math.inf)
    fall = scene.z0 + scene.v0 * t - scene.g * t * t / 2
    off = z - fall
    if before.sum() > 2 and not np.allclose(off[before], 0.0, atol=1e-8):
        drift = np.abs(np.abs(off) - scene.g * h * t / 2)
        return named("EULER_IN_FLIGHT") if np.all(drift[before] < 1e-6) else None
    if np.allclose(z, fall, rtol=1e-9, atol=1e-8):
        return named("PASSES_THROUGH")
    code = _drop_formula(scene, t, z, h) or _drop_end(scene, t, z, v, h) or _drop_blow(scene, t, z, v, h)
    return named(code) if code else None


def _drop_formula(scene, t, z, h):
    """The wrong restitution or radius that leads exactly this way up to the time of rest."""
    e = scene.restitution
    others = (
        ("RADIUS_IGNORED", replace(scene, radius=0.0)),
        ("RESTITUTION_SQUARED", replace(scene, restitution=e * e)),
        ("RESTITUTION_AS_ENERGY", replace(scene, restitution=math.sqrt(e))),
        ("RESTITUTION_IGNORED", replace(scene, restitution=1.0)),
        ("RESTITUTION_IGNORED", replace(scene, restitution=0.0)),
    )
    first = scene.contacts(t[-1], scene.g * h)[0][:1]
    for code, other in others:
        if other == scene:
            continue
        # Up to where it may rest; a ball that stops dead at its first contact is followed to the end.
        early = t < (other.settling(t[-1], h)[0] if other.restitution else math.inf)
        bounced = np.any(t[early] > first) if len(first) else False
        if bounced and np.allclose(z[early], other.at(t, scene.g * h)[0][early], atol=1e-8):
            return code
    return None


def _drop_end(scene, t, z, v, h):
    """How it ends, if it goes right until it may rest."""
    may, must = scene.settling(t[-1], h)
    true = scene.at(t, scene.g * h)[0]
    wrong = np.flatnonzero(np.abs(z - true) > 1e-8)
    rests = np.abs(z - scene.radius) < 1e-9
    if len(wrong) and t[wrong[0]] < may:
        still = rests[wrong[0] :].all() and np.all(v[wrong[0] :] == 0.0)
        return "RESTS_TOO_EARLY" if still else None
    late = t > must
    if not late.any():
        return None
    if np.any(z[late] < scene.radius - 1e-9) and z[-1] < scene.radius - 1e-6:
        return "SINKS_THROUGH_FLOOR"
    return "RESTING_JITTER" if np.any(~rests[late]) or np.any(v[late] != 0.0) else None


def _drop_blow(scene, t, z, v, h):
    """What happens around the first contact, if the flight before it is right."""
    times, speeds = scene.contacts(t[-1], scene.g * h)
    if not len(times):
        return None
    k = int(np.searchsorted(t, times[0]))  # the first sample at or after the contact
    if k >= len(t):
        return None
    stuck = math.isclose(z[k], scene.radius, abs_tol=1e-9)
    if stuck and abs(v[k] - speeds[0]) < 1e-8:
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
