"""What a failed check of ``collisions`` shows of the mistake behind it.

Each probe looks for a property that a family of mistakes has: which law is broken, where a nan comes from,
which bodies are concerned. Which known program it is, ``hypotheses.json`` tells; a probe speaks where none
of them fits. What the paths of the two simulations show is in ``tracks.py``.
"""

from __future__ import annotations

import math

import numpy as np

from course.grading import kit

named = kit.words("collisions")

# -- single calls ---------------------------------------------------------------------------------------


@np.errstate(all="ignore")
def of_calls(task, calls, values, truth):
    """What the answers of a task to ``calls`` show, beside the right ones (``truth``); or None."""
    code = _not_a_number(task, calls, values, truth)
    if not code and not all(map(_same, truth, values)):
        code = (
            _moment(task, calls, values, truth)
            or _of_contact(task, values, truth)
            or _unmoved(task, calls, values)
            or _concerned(task, calls, values, truth)
            or _by_law(task, calls, values, truth)
        )
    return named(code) if code else None


def _of_contact(task, values, truth):
    """Whether ``touching`` alone is wrong, or the normal is no direction at all."""
    if not task.startswith("detect"):
        return None
    if any(not np.any(value[1]) for value in values):
        return "NORMAL_IS_ZERO"
    wrong = [(value, right) for value, right in zip(values, truth, strict=True) if not _same(right, value)]
    return "TOUCHING_WRONG" if all(_same(right[1:], value[1:]) for value, right in wrong) else None


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


def _concerned(task, calls, values, truth):
    """Which pairs are wrong, or which of the two bodies: those that part, those left alone, one of them."""
    if task != "impulse_1d" and not task.startswith("resolve"):
        return None
    pairs = list(zip(calls, values, truth, strict=True))
    wrong = [pair for pair in pairs if not _same(pair[2], pair[1])]
    idle = [(0.0 if task == "impulse_1d" else (call[2], call[3])) for call, _, _ in wrong]
    if all(_closing(task, call) <= 0 for call, _, _ in wrong):
        kept = task == "impulse_1d" or not any(_momentum_lost(call, value) for call, value, _ in wrong)
        return "IMPULSE_ON_SEPARATING" if kept else None
    struck = any(pair not in wrong and _closing(task, pair[0]) > 0 for pair in pairs)
    if struck and all(_same(still, value) for still, (_, value, _) in zip(idle, wrong, strict=True)):
        return "SOME_PAIRS_SPARED"
    if task == "impulse_1d" or (not struck and len(wrong) < 2):
        return None
    # A body that cannot move is always right.
    moves = [any(np.isfinite(call[body]) for call, _, _ in wrong) for body in (0, 1)]
    one = any(moves[body] and all(_same(y[body], x[body]) for _, x, y in wrong) for body in (0, 1))
    return "ONE_BODY_RIGHT" if one else None


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
    for call, value, right in zip(calls, values, truth, strict=True):
        if value is None or _same(right, value):
            continue
        if right is None:
            # Only a time at which they do touch is a contact that was, or one that is to come.
            if _apart(call, value) >= 1e-6:
                return "MISS_IS_A_NUMBER"
            return "IMPACT_IN_THE_PAST" if value < 0.0 else _beyond(call, value)
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
