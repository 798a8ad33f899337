"""What a failed check of ``collisions`` shows of the mistake behind it.

Each probe looks for a property that a family of mistakes has: which law is broken, where a nan comes from,
which bodies are concerned. Which known program it is, ``hypotheses.json`` tells; a probe speaks where none
of them fits. What the paths of the two simulations show is in ``tracks.py``.
"""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np

from course.scoring import kit

named = kit.words("collisions")

#: A step is searched in no more samples than this. Of other numbers, one in twenty is as near to such a part.
_SAMPLES = 10_000

# -- single calls ---------------------------------------------------------------------------------------


@np.errstate(all="ignore")
def of_calls(task, calls, values, truth):
    """What the answers of a task to ``calls`` show, beside the right ones (``truth``); or None."""
    code = _not_a_number(task, calls, values, truth)
    if not code and not all(map(_same, truth, values)):
        code = (
            _moment(task, calls, values, truth)
            or _of_contact(task, calls, values, truth)
            or _rounded(task, values, truth)
            or _of_walls(task, calls, values, truth)
            or _only_where(task, calls, values, truth)
            or _unmoved(task, calls, values)
            or _concerned(task, calls, values, truth)
            or _by_law(task, calls, values, truth)
        )
    return named(code) if code else None


def _of_contact(task, calls, values, truth):  # noqa: PLR0911 - one return per mistake
    """Whether ``touching`` alone is wrong, or the normal is no direction at all."""
    if not task.startswith("detect"):
        return None
    if any(not np.any(value[1]) for value in values):
        return "NORMAL_IS_ZERO"
    wrong = [
        (call, value, right)
        for call, value, right in zip(calls, values, truth, strict=True)
        if not _same(right, value)
    ]
    if all(_same(right[1:], value[1:]) for _, value, right in wrong):
        return "TOUCHING_WRONG"
    close = [np.allclose([*v[1], v[2]], [*right[1], right[2]], rtol=1e-6, atol=1e-6) for _, v, right in wrong]
    if all(close) and 2 * len(wrong) > len(values):
        return "PRECISION_LOST"
    if all(_same((right[1], abs(right[2])), (value[1], value[2])) for _, value, right in wrong) and any(
        value[2] > 0 > right[2] for _, value, right in wrong
    ):
        return "DEPTH_UNSIGNED"
    if all(not math.isclose(float(np.sqrt(value[1] @ value[1])), 1.0, rel_tol=1e-9) for _, value, _ in wrong):
        # Normal times distance is the vector between the centres, if both have the same distance.
        both = task == "detect_sphere_sphere" and all(
            _same(call[2] - call[0], value[1] * (call[1] + call[3] - value[2])) for call, value, _ in wrong
        )
        return "DISTANCE_WRONG" if both else "NORMAL_NOT_UNIT"
    if all(_same((-right[1], right[2]), value[1:]) for _, value, right in wrong) and len(wrong) < len(values):
        return "NORMAL_REVERSED_AT_TIMES"
    if task == "detect_sphere_sphere":
        return _near_centres(calls, values, truth)
    return _other_height(wrong)


def _near_centres(calls, values, truth):
    """Whether the normal alone is wrong, and only where the centres nearly coincide."""
    apart = np.array([float(np.linalg.norm(call[2] - call[0])) / (call[1] + call[3]) for call in calls])
    off = np.array([not _same(right, value) for value, right in zip(values, truth, strict=True)])
    only = all(_same((r[0], r[2]), (v[0], v[2])) for v, r in zip(values, truth, strict=True))
    near = (apart > 0) & (apart < 0.01)
    return "NEAR_CENTRES_COINCIDE" if only and not off.all() and np.array_equal(off, near) else None


def _other_height(wrong):
    """What takes the place of the height above a plane, if it is one thing in all wrong answers."""
    if len(wrong) < 2 or not all(_same(right[1], value[1]) for _, value, right in wrong):
        return None
    ways = (
        ("DISTANCE_TO_POINT", lambda x, r, point, n, right: float(np.linalg.norm(x - point))),
        ("HEIGHT_ALONG_AN_AXIS", lambda x, r, point, n, right: (r - right) / n[-1]),
        ("DEPTH_ALONG_AN_AXIS", lambda x, r, point, n, right: r - right / abs(n[-1])),
    )
    for code, height in ways:
        seen = [(call[1] - value[2], height(*call, right[2])) for call, value, right in wrong]
        if all(_same(abs(other), abs(found)) for found, other in seen):
            return code
    return None


def _not_a_number(task, calls, values, truth):
    """Where nan comes from: coinciding centres, infinite masses, no slip, no relative motion."""
    spoiled = [call for call, value in zip(calls, values, strict=True) if _has_nan(value)]
    if not spoiled:
        return None
    if task == "detect_sphere_sphere":
        return "NORMAL_UNDEFINED" if all(np.array_equal(call[0], call[2]) for call in spoiled) else None
    if task == "time_of_impact":
        return _moment_not_a_number(calls, values, truth)
    if task in ("impulse_1d", "resolve", "resolve_with_friction"):
        if all(math.inf in call[:2] for call in spoiled):
            return "INFINITE_MASS_NAN"
        if task == "resolve_with_friction" and all(not _slip(call).any() for call in spoiled):
            return "NO_SLIDING_NAN"
    return None


def _slip(call):
    """The slip of b as seen from a, m/s; rounding is none."""
    u, n = call[3] - call[2], call[4]
    across = u - (u @ n) * n
    return np.where(np.abs(across) < 1e-12, 0.0, across)


def _moment_not_a_number(calls, values, truth):
    """Which division or root gives nan, if nan is what is wrong with the first answer that is."""
    for call, value, right in zip(calls, values, truth, strict=True):
        if _has_nan(value):
            x, v = call[3] - call[0], call[4] - call[1]
            if not v.any():
                return "NO_RELATIVE_MOTION"
            beside = (x @ v) ** 2 < v @ v * (x @ x - (call[2] + call[5]) ** 2)
            return "ROOT_OF_A_NEGATIVE" if beside else "MISS_IS_A_NUMBER" if right is None else None
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


def _rounded(task, values, truth):
    """Whether most results of impacts are wrong, and none by more than a rounding to six digits."""
    if task != "impulse_1d" and not task.startswith("resolve"):
        return None
    close = [
        np.allclose(value, right, rtol=1e-6, atol=1e-6) for value, right in zip(values, truth, strict=True)
    ]
    wrong = sum(not _same(right, value) for value, right in zip(values, truth, strict=True))
    return "PRECISION_LOST" if all(close) and 2 * wrong > len(values) else None


def _of_walls(task, calls, values, truth):
    """What is wrong with walls, if nothing but walls is wrong."""
    if task != "impulse_1d" and not task.startswith("resolve"):
        return None
    wrong = [c for c in zip(calls, values, truth, strict=True) if not _same(c[2], c[1])]
    if not all(math.inf in call[:2] for call, _, _ in wrong):
        return None
    if task == "impulse_1d":
        own = [_wall_at_rest(call) for call, _, _ in wrong]
        at_rest = any(own) and all(map(_same, own, (value for _, value, _ in wrong)))
        return "WALL_ASSUMED_AT_REST" if at_rest else None
    cases = [_at_wall(*case) for case in wrong]
    if not any(kept for kept, *_ in cases):
        return "WALL_MOVED"
    changes = [change for _, *change in cases]
    if task == "resolve_with_friction":
        smooth = all(
            _same(true, along) and not np.any(np.abs(across) > 1e-9) for along, across, true, _ in changes
        )
        rubbed = [c for c in zip(calls, truth, strict=True) if _slip(c[0]).any() and c[0][6]]
        every = len(wrong) == sum(math.inf in call[:2] and _closing(task, call) > 0 for call, _ in rubbed)
        return "WALLS_SMOOTH" if smooth and every else None
    rest = all(_same(at_rest, along) or (not along and at_rest <= 0) for along, _, _, at_rest in changes)
    return "WALL_ASSUMED_AT_REST" if rest and any(along for along, *_ in changes) else None


def _at_wall(call, value, right):
    """Whether a wall keeps its velocity; then of the other body's change the part away from it, the part
    across the normal, the right part away from it, and that part if the wall did not move."""
    wall = 0 if call[0] == math.inf else 1
    away = call[4] if wall == 0 else -call[4]
    old, new, true = (part[1 - wall] for part in (call[2:4], value, right))
    along = float((new - old) @ away)
    at_rest = -(1 + call[5]) * float(old @ away)
    return (
        _same(call[2 + wall], value[wall]),
        along,
        new - old - along * away,
        float((true - old) @ away),
        at_rest,
    )


def _only_where(task, calls, values, truth):
    """What is common to all calls with a wrong answer, and to no other: a special case that is none."""
    if task != "impulse_1d" and not task.startswith("resolve"):
        return None
    wrong = [not _same(right, value) for value, right in zip(values, truth, strict=True)]
    rebound = 4 if task == "impulse_1d" else 5

    def alike(call, within):
        # Without loss equal masses exchange their velocities: a special case for them is right there.
        ma, mb = call[:2]
        return 1 - within < ma / mb < 1 + within and not (ma == mb and call[rebound] == 1.0)

    special = (
        ("ONLY_WITHOUT_REBOUND", lambda call: call[rebound] == 0.0),
        ("ONLY_EQUAL", lambda call: alike(call, 1e-9)),
        ("ONLY_NEARLY_EQUAL", lambda call: alike(call, 0.01)),
        ("ONLY_NEARLY_EQUAL", lambda call: alike(call, 1e-4)),
        ("ONLY_NEARLY_EQUAL", lambda call: alike(call, 0.01) and call[0] != call[1]),
        ("ONLY_NEARLY_EQUAL", lambda call: alike(call, 1e-4) and call[0] != call[1]),
        ("ONLY_VERY_UNEQUAL", lambda call: max(call[:2]) > 1e4 * min(call[:2]) and math.inf not in call[:2]),
    )
    return next((code for code, is_so in special if list(map(is_so, calls)) == wrong), None)


def _wall_at_rest(call):
    """The impulse on a line if the wall did not move."""
    ma, mb, va, vb, e = call
    closing = -vb if ma == math.inf else va
    return (1 + e) * max(closing, 0.0) * min(ma, mb)


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
    right = [_same(known, value) for _, value, known in pairs]
    wrong = [pair for pair, met in zip(pairs, right, strict=True) if not met]
    idle = [(0.0 if task == "impulse_1d" else (call[2], call[3])) for call, _, _ in wrong]
    if all(_closing(task, call) <= 0 for call, _, _ in wrong):
        kept = task == "impulse_1d" or not any(_momentum_lost(call, value) for call, value, _ in wrong)
        return "IMPULSE_ON_SEPARATING" if kept else None
    struck = any(met and _closing(task, call) > 0 for (call, _, _), met in zip(pairs, right, strict=True))
    if struck and all(_same(still, value) for still, (_, value, _) in zip(idle, wrong, strict=True)):
        speeds = [(_closing(task, call), met) for (call, _, _), met in zip(pairs, right, strict=True)]
        slowest = min(speed for speed, met in speeds if met and speed > 0)
        slow = all(speed < 0.1 * slowest for speed, met in speeds if not met)
        return "SLOW_PAIRS_SPARED" if slow else "SOME_PAIRS_SPARED"
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
    rubs = _rubs(calls, values, truth) if task == "resolve_with_friction" else None
    if rubs == "FRICTION_DRIVES":  # it may add energy, too
        return rubs
    if task != "impulse_1d":
        # The first wrong pair is the one whose numbers stand beside the finding.
        call, value = next(
            (c, v) for c, v, known in zip(calls, values, truth, strict=True) if not _same(known, v)
        )
        if _closing(task, call) > 0 and math.inf not in call[:2]:
            if energy(*call[:2], *value) > energy(*call[:4]) * (1 + 1e-9):
                return "ENERGY_CREATED"
            if _momentum_lost(call, value):
                return "MOMENTUM_LOST"
    askew = task == "resolve" and _askew(calls, values, truth)
    return "BLOW_NOT_ALONG_NORMAL" if askew else rubs or _by_speeds(task, colliding)


def _askew(calls, values, truth):
    """Whether every wrong pair that meets, walls aside, exchanges momentum across the normal as well."""
    across = []
    for call, value, right in zip(calls, values, truth, strict=True):
        if _closing("resolve", call) > 0 and math.inf not in call[:2] and not _same(right, value):
            if _momentum_lost(call, value):
                return False
            changes = np.subtract(value, call[2:4])
            across.append(np.max(np.abs(changes - np.outer(changes @ call[4], call[4]))))
    return len(across) > 1 and min(across) > 1e-8


def _by_speeds(task, colliding):
    """Whether bodies part too fast in all impacts, or too slowly, or the slow ones alone."""
    excess = np.array([_excess(task, c, v) for c, v in colliding])
    if _fades(task, colliding, excess):
        return "RESTITUTION_DROPPED_WHEN_SLOW"
    if np.all(excess > 1e-8):
        return "BLOW_TOO_STRONG"
    return "BLOW_TOO_WEAK" if np.all(excess < -1e-8) else None


def _fades(task, colliding, excess):
    """Whether fast pairs part as they should, and the slower ones the less so, and no pair loses momentum."""
    rebound = 4 if task == "impulse_1d" else 5
    meetings = [
        (_closing(task, call), call[rebound], off) for (call, _), off in zip(colliding, excess, strict=True)
    ]
    kept = np.array([1 + off / (e * speed) for speed, e, off in sorted(meetings) if e])
    falls = len(kept) > 3 and np.all(np.diff(kept) > -1e-9) and kept[0] > -1e-9
    whole = task == "impulse_1d" or not any(_momentum_lost(*pair) for pair in colliding)
    return bool(falls and whole and kept[0] < 0.9 and 0.98 < kept[-1] < 1 + 1e-9)


def _rubs(calls, values, truth):
    """How friction is wrong, where all else is right: its direction, or its size."""
    if _slow_slips(calls, values, truth):
        return "SLOW_SLIPS_SPARED"
    seen = []
    for call, value, right in zip(calls, values, truth, strict=True):
        if _same(right, value):
            continue
        va, vb, n = call[2:5]
        along = ([float(part @ n) for part in parts] for parts in (right, value))
        if not np.isfinite(call[1]) or not all(map(_same, *along)):
            return None
        slip, wanted, found = (u - (u @ n) * n for u in (vb - va, right[1] - vb, value[1] - vb))
        size = float(np.sqrt(slip @ slip))
        if not size or _same(right[1], value[1]):
            return None
        along = float(found @ slip) / size
        if not np.allclose(found, along * slip / size, rtol=0, atol=1e-8):
            seen.append("FRICTION_ASKEW")
            continue
        if _momentum_lost(call, value):
            return None
        left = ((value[1] - value[0]) @ slip) / size
        more = along < float(wanted @ slip) / size
        turns = "FRICTION_TURNS_THE_SLIP" if left < -1e-8 else ""
        size_wrong = "FRICTION_TOO_STRONG" if more else "FRICTION_TOO_WEAK"
        seen.append("FRICTION_DRIVES" if along > 1e-8 else turns or size_wrong)
    # The numbers of the first stand beside the finding; a size is said if it is that of all.
    if seen and (seen[0] == "FRICTION_ASKEW" or len(set(seen)) == 1):
        return seen[0]
    return None


def _slow_slips(calls, values, truth):
    """Whether friction is missing only between the bodies that slide most slowly."""
    slow, fast = [], []
    for call, value, right in zip(calls, values, truth, strict=True):
        slip = float(np.linalg.norm(_slip(call)))
        if not _same(right, value):
            n = call[4]
            changes = [np.subtract(answer, call[2:4]) for answer in (value, right)]
            smooth = np.allclose(changes[0], np.outer(changes[1] @ n, n), rtol=1e-9, atol=1e-9)
            if not smooth:
                return False
            slow.append(slip)
        elif slip and call[6] and _closing("resolve", call) > 0:
            fast.append(slip)
    return bool(slow and fast) and max(slow) < 0.1 * min(fast)


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
    return _wrong_moment(calls, values, truth)


def _wrong_moment(calls, values, truth):
    for call, value, right in zip(calls, values, truth, strict=True):
        if value is None or _same(right, value):
            continue
        if right is None:
            if value == 0.0 and _overlap(call):
                return "OVERLAP_ALWAYS_HITS" if _parting_hits(calls, values) else "OVERLAP_LEVEL_HITS"
            # Only a time at which they do touch is a contact that was, or one that is to come.
            if not _apart(call, value) < 1e-6:
                return None if _overlap(call) else "MISS_IS_A_NUMBER"
            return "IMPACT_IN_THE_PAST" if value < 0.0 else _beyond(call, value)
        if 0.0 in (right, value):
            near = value == 0.0 and _apart(call, 0.0) < 0.01
            return "OVERLAP_IN_THE_PAST" if value < 0.0 else "GAP_AS_OVERLAP" if near else None
        # The other root of the quadratic lies as far beyond the closest approach as this one before it.
        dx, dv = call[3] - call[0], call[4] - call[1]
        late = -2 * float(dx @ dv) / float(dv @ dv) - right
        return "TIME_OF_IMPACT_LATE_ROOT" if right > 0.0 and _same(late, value) else None
    return None


def _parting_hits(calls, values):
    """Whether any spheres that overlap and move apart, and are not only no nearer, get a time."""
    return any(
        value is not None and _overlap(call) and (call[3] - call[0]) @ (call[4] - call[1]) > 1e-12
        for call, value in zip(calls, values, strict=True)
    )


def _beyond(call, value):
    return "IMPACT_BEYOND_STEP" if value > call[-1] and not _overlap(call) else None


def _overlap(call):
    """Whether two spheres overlap at the start."""
    x = call[3] - call[0]
    return float(np.sqrt(x @ x)) < call[2] + call[5]


def _apart(call, t):
    """By how much the surfaces of two spheres are apart, or overlap, at time t, as a share of the radii."""
    xa, va, ra, xb, vb, rb, _ = call
    x = xb - xa + t * (vb - va)
    return abs(float(np.sqrt(x @ x)) - ra - rb) / (ra + rb)


def _which_are_missed(calls, values, truth):
    """What tells the contacts that are missed from all that are found, as a code, or None.

    Where two answers fit, neither is known.
    """
    asked = [(call, value) for call, value, right in zip(calls, values, truth, strict=True) if right]
    found = [
        _same(right, value) for value, right in zip(values, truth, strict=True) if right and value is not None
    ]
    if not all(found) or not 2 <= len(found) <= len(asked) - 2:
        return None
    fits = [code for code, test in _MISSED if all(test(*c) == (value is None) for c, value in asked)]
    return fits[0] if len(fits) == 1 else None


def _out_of_reach(xa, va, ra, xb, vb, rb, dt):
    return float(np.linalg.norm(xb - xa)) - ra - rb > max(np.linalg.norm(va), np.linalg.norm(vb)) * dt


def _overlap_at_end(xa, va, ra, xb, vb, rb, dt):
    return float(np.linalg.norm(xb - xa + dt * (vb - va))) < ra + rb


def _closest_later(xa, va, _ra, xb, vb, _rb, dt):
    return -float((xb - xa) @ (vb - va)) > dt * float((vb - va) @ (vb - va))


_MISSED = (
    ("REACH_OF_ONE_BODY", _out_of_reach),
    ("PARTING_WITHIN_STEP", _overlap_at_end),
    ("CLOSEST_AFTER_STEP", _closest_later),
)


def _coarse(calls, values, truth):
    """Contacts that are missed, or found at about the right time."""
    pairs = [(right, value, call[-1]) for call, value, right in zip(calls, values, truth, strict=True)]
    if missed := _which_are_missed(calls, values, truth):
        return missed
    if any(right is None and value is not None for right, value, _ in pairs):
        return (
            "CONTACTS_MISSED"
            if any(value is None and right is not None for right, value, _ in pairs)
            else None
        )
    found = [pair for pair in pairs if None not in pair]
    if _brief(calls, values, truth):
        return "BRIEF_CONTACTS_MISSED"
    near = all(abs(value - right) <= 0.05 * dt for right, value, dt in found)
    if len(found) == sum(right is not None for right, _, _ in pairs):
        return "MOMENT_TOO_COARSE" if near else None
    # A search in steps finds the others a little late, at an instant that it looks at.
    late = all(value >= right - 1e-9 for right, value, _ in found)
    rough = [(value, dt) for right, value, dt in found if not _same(right, value)]
    return "TUNNELS" if near and late and rough and _sampled(rough) else "CONTACTS_MISSED"


def _brief(calls, values, truth):
    """Whether all times are right, and only contacts are missed at which bodies overlap for a short time."""
    missed, found = [], []
    for call, value, right in zip(calls, values, truth, strict=True):
        if right:
            x, v = call[3] - call[0], call[4] - call[1]
            late = -2 * float(x @ v) / float(v @ v) - right
            (missed if value is None else found).append((late - right) / call[-1])
        if value is not None and not _same(right, value):
            return False
    return bool(missed and found) and max(missed) < min(0.05, *found)


def _sampled(found):
    """Whether times, each with its dt, are whole parts of dt, or of a second, as those of samples are."""
    parts = [[value / dt for value, dt in found], [value for value, _ in found]]
    return any(
        all(abs(part - Fraction(part).limit_denominator(_SAMPLES)) < 1e-9 for part in each) for each in parts
    )


@np.errstate(all="ignore")
def momentum(ma, mb, va, vb):
    """Total momentum, kg m/s."""
    return ma * np.asarray(va, dtype=float) + mb * np.asarray(vb, dtype=float)


@np.errstate(all="ignore")
def energy(ma, mb, va, vb):
    """Total kinetic energy, J."""
    return 0.5 * (ma * float(np.dot(va, va)) + mb * float(np.dot(vb, vb)))
