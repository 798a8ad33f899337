"""Finding out which mistake ``sync`` or ``command`` of ``digital-twin`` makes."""

from __future__ import annotations

import dataclasses
import math
from contextlib import suppress

import numpy as np

from course.scoring import kit

named = kit.words("digital-twin")
scenes = kit.companion("digital-twin", "scenes")


def states(values):
    """t, position, speed, friction of each twin, shape (n, 4); a twin with other keys is a finding."""
    return _rows(kit.as_record(value, scenes.KEYS, "the twin") for value in values)


def path(folded):
    """The same of a run folded with ``keep=scenes.SEEN``: all twins but the last have these keys only."""
    *along, last = folded
    seen = [kit.as_record(value, scenes.SEEN, "the twin") for value in along]
    return _rows([*seen, kit.as_record(last, scenes.KEYS, "the twin")])


def _rows(twins):
    return np.array([[kit.as_number(twin[key], key) for key in scenes.SEEN] for twin in twins])


def numbers_in(value):
    """How many numbers there are in plain data."""
    if isinstance(value, dict):
        return sum(map(numbers_in, value.values()))
    if isinstance(value, list | tuple):
        return sum(map(numbers_in, value))
    return int(np.size(value))


def same(a, b):
    """Whether two plain values are equal, arrays and lists alike, to rounding."""
    with suppress(ValueError, DeprecationWarning):  # an array has no one answer
        if a == b:
            return True
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    if isinstance(a, list | tuple | np.ndarray) and isinstance(b, list | tuple | np.ndarray):
        return len(a) == len(b) and all(map(same, a, b))
    if isinstance(a, float | int) and isinstance(b, float | int):
        return (math.isnan(a) and math.isnan(b)) or abs(a - b) <= 1e-9 * (1 + abs(b))
    return bool(np.all(a == b))


@np.errstate(all="ignore")  # a submission may have returned anything
def of_sync(submission, refuted=(), stops=False):
    """The mistake that ``sync`` makes: first in single steps, then along a run of its own.

    refuted: codes of mistakes that make no difference to the numbers of the check that asks
    stops: whether the friction came to the same number again and again in that check
    """
    looks = (
        lambda: [_braking(submission)],
        lambda: _in_one_step(submission),
        lambda: [_backwards(submission), _against_the_drive(submission), _learning(submission)],
        lambda: [_drops_large_ones(submission)],
        lambda: [_limit(submission) if stops else None, _predicts_otherwise(submission)],
    )
    codes = []
    for look in looks:
        codes += filter(None, look())
        if codes and codes[0] not in _APART:
            break
    left = [code for code in codes if code not in refuted]
    if codes and codes[0] in refuted:
        return second_mistake(named(left[0]) if left else None)
    if not left:
        return None
    about = _APART.get(left[0])
    others = [code for code in left if about and _APART.get(code, about) != about]
    first = named(left[0])
    if not others:
        return first
    second = named(others[0])
    return dataclasses.replace(
        first,
        looks_like=f"There seem to be two mistakes. First: {first.looks_like} Second: {second.looks_like}",
        advice=f"First: {first.advice} Second: {second.advice}",
    )


def second_mistake(seen):
    """What is said where the mistake of other checks makes no difference: what was seen besides, if anything.

    It is a fact, which stays with its check whatever the others say.
    """
    return dataclasses.replace(seen, code="SECOND_MISTAKE") if seen else named("SECOND_MISTAKE")


#: Mistakes that are seen beside others, and what they are about: one never looks like one of another kind.
_APART = {
    "BELIEVES_MEASUREMENT": "position",
    "STEP_FIXED": "time",
    "DRIVE_NOT_USED": "drive",
    "DRIVE_CHANGED": "drive",
    "LATE_USED_AS_CURRENT": "late",
    "PAST_WITH_NEW_DRIVE": "late",
    "LATE_STATE_AS_CURRENT": "late",
    "SPEED_NOT_CORRECTED": "speed",
    "SPEED_SHARE_OVER_DT": "speed",
    "SPEED_CORRECTED_BACKWARDS": "speed",
    "FRICTION_LEARNS_BACKWARDS": "friction",
    "LEARNS_FORWARDS_ONLY": "friction",
    "FRICTION_HELD_BACKWARDS": "friction",
    "FRICTION_SIGN_OF_DRIVE": "friction",
    "FRICTION_NOT_LEARNED": "friction",
}


#: m; no more than noise may be, or a twin that leaves outliers out is right to move by nothing
_SURPRISE = scenes.SIGMA


def _run(submission, friction, frictions, seconds, seed=3):
    """The twins along a run without late measurements, and the truth beside them."""
    cart = scenes.Cart(frictions, v=1.0)
    times = 0.1 * np.arange(1, round(10 * seconds) + 1)
    run = scenes.measured(cart, 0.5, times, np.random.default_rng(seed))
    twins = submission.fold("sync", scenes.new_twin(friction, 0.5, speed=1.0), run.calls)
    return twins, run.truth


def _warm(submission):
    """(twin, whether it is a good one): of a steady cart after five seconds, or just before it went astray.

    What a twin does that is far off shows nothing: there a surprise of the experiment's is lost in its own.
    """
    twins, truth = _run(submission, 0.5, ((0.0, 0.5),), 5.0)
    off = np.abs(states(twins)[1:, 1:3] - truth[:, 1:]).max(axis=1)
    astray = np.flatnonzero(~(off < 0.5))
    return (twins[astray[0]], False) if len(astray) else (twins[-1], True)


def _braking(submission):
    """What friction does in the prediction that it should not: speed a cart up, or brake each one alike."""
    (_, slow), (_, fast) = (_expected(submission, v) for v in (1.0, 2.0))
    if slow > 1.03:
        # With hardly any friction it must be slower: then it is friction that speeds it up.
        return "FRICTION_SPEEDS_UP" if slow > _expected(submission, 1.0, friction=0.05)[1] + 0.02 else None
    # Friction of 0.5 1/s takes 0.1 m/s off in 0.2 s at 1 m/s, and twice as much at 2 m/s.
    return "FRICTION_WITHOUT_SPEED" if 1.0 - slow > 0.03 and abs(slow + 1.0 - fast) < 0.01 else None


def _predicts_otherwise(submission):
    """What else a prediction without a surprise lacks: the friction, or what it does on the way."""
    (x, v), (_, smooth) = (_expected(submission, 1.0, friction) for friction in (0.5, 0.05))
    if abs(v - smooth) < 1e-6:
        return "FRICTION_NOT_IN_MODEL"
    return "POSITION_OF_OLD_SPEED" if v < 0.97 and abs(x - 3.2) < 1e-6 else None


def _expected(submission, speed, friction=0.5):
    """Position and speed that a new twin predicts for 0.2 s later, from what it makes of three positions.

    Its corrections are the more the further it is surprised, so there is a position that it predicts; where
    they are not, it is nan. At 3 m, a friction that acts on the position takes off more than on the speed.
    """
    z = 3.0 + np.array([0.18, 0.19, 0.2]) * speed
    new = scenes.new_twin(friction, 0.0, speed=speed, position=3.0)
    calls = [(new, float(seen), 0.2) for seen in z]
    rows = states(submission.call_each("sync", calls))
    x, v = rows[:, 1], rows[:, 2]
    share, gain = (x[2] - x[0]) / (z[2] - z[0]), (v[2] - v[0]) / (z[2] - z[0])
    bent = max(abs(x[0] + x[2] - 2 * x[1]), abs(v[0] + v[2] - 2 * v[1]))
    if not (bent < 1e-9 and abs(share - 1) > 1e-3 and abs(share) > 1e-3):
        return math.nan, math.nan
    expected = (x[0] - share * z[0]) / (1 - share)
    return expected, v[0] + gain * (expected - z[0])


def _in_one_step(submission):
    """Codes of what one more measurement does."""
    warm, good = _warm(submission)
    t, x, v, b = states([warm])[0].tolist()
    if not math.isfinite(t + x + v):
        return []  # what it has made of a steady cart is beyond experiments
    before, b = (x, b), b if 0.01 < b < 100.0 else 0.5
    soon, expected = (_predicted(warm, b, dt) for dt in (0.1, 0.2))
    pushed = {**warm, "drive": warm["drive"] + 4.0}
    at_once = [(warm, z, t + 0.1) for z in (soon, soon + _SURPRISE)]
    behind = [(warm, z, t - 0.4) for z in (x - 0.4 * v, x - 0.4 * v + _SURPRISE)]
    usual = [(warm, expected + n * _SURPRISE, t + 0.2) for n in (0, 1, 0, -5, 2, 5)]
    asked = [*usual, (pushed, expected, t + 0.2), *at_once, *behind, (pushed, *behind[0][1:])]
    twins = submission.call_each("sync", asked)
    rows = states(twins)
    (t0, x0, v0, b0), (_, ahead, v_ahead, b_ahead) = rows[:2]
    (_, driven, v_driven, _), (t_late, x_late, _, _) = rows[6], rows[9]
    kept = [kit.as_number(twins[i]["drive"], "drive") for i in (1, 6)] == [warm["drive"], pushed["drive"]]
    kept = kept and kit.as_number(twins[1]["sigma"], "sigma") == scenes.SIGMA
    moved, far = (ahead - x0) / _SURPRISE, max(abs(row[1] - x0) for row in rows[1:6])
    gains = (v_ahead - v0) / _SURPRISE * 0.2, (rows[8, 2] - rows[7, 2]) / _SURPRISE * 0.1
    # Where a twin without a surprise would be, as shares of the way; and where a late one has none.
    went = (_unsurprised(x0, ahead, expected) - x) / (expected - x)
    went_soon = (_unsurprised(rows[7, 1], rows[8, 1], soon) - x) / (soon - x)
    unsurprised = _unsurprised(x_late, rows[10, 1], x - 0.4 * v)
    now, then = (abs(unsurprised - place) < 0.05 * abs(v) for place in (x, x - 0.4 * v))
    seen = [z for _, z, _ in (*usual, *at_once)]
    believed = np.allclose(rows[[0, 1, 2, 3, 4, 5, 7, 8], 1], seen, rtol=0, atol=1e-9)
    # The drive acts from the twin's time on: what it is by now tells nothing of a moment 0.4 s ago.
    late_apart = abs(rows[11, 2] - rows[9, 2]) > 0.05
    # Of a position that is the measured one, the drive shows in the friction alone, if at all.
    undriven = abs(v_driven - v0) < 0.05 and abs(driven - x0) < 1e-6 and not believed
    tests = (
        ("GLOBAL_MEMORY", not same(twins[0], twins[2])),
        ("DRIVE_CHANGED", not kept),
        ("TIME_NOT_ADVANCED", abs(t0 - t) < 1e-9),
        ("TIME_RUNS_BACK", good and t_late < t - 1e-9),
        ("TIME_NOT_THE_LATEST", abs(t0 - t - 0.2) > 1e-6),
        ("NO_CORRECTION", far <= 1e-6 * _SURPRISE),
        ("LARGE_SURPRISES_DROPPED", good and np.all(np.ptp(rows[3:6, 1:], axis=0) < 1e-9)),
        ("SURPRISE_INVERTED", moved < -1e-6),
        ("SMALL_SURPRISES_IGNORED", abs(moved) <= 1e-6 < abs(rows[5, 1] - x0) / _SURPRISE),
        ("BELIEVES_MEASUREMENT", believed),
        ("SURPRISE_OF_OLD_POSITION", _of_old_position(*before, (expected, *rows[:2]), (soon, *rows[7:9]))),
        ("STEP_FIXED", abs(went - 0.5) < 0.06 and abs(went_soon - 1.0) < 0.06),
        ("NO_PREDICTION", max(abs(went), abs(went_soon)) < 0.02),
        ("PREDICTS_TOO_LITTLE", went < 0.75),
        ("SPEED_DIFFERENTIATED", all(abs(gain - 1) < 0.05 for gain in gains)),
        ("DRIVE_NOT_USED", undriven and not _driven_at_first(submission)),
        ("DRIVE_REMEMBERED", undriven),
        # As if it were new: by that share of the way back, or so, and not by twice as much.
        ("LATE_USED_AS_CURRENT", good and now and 0.02 < (x - x_late) / abs(v) < 0.64 * max(moved, 0.1)),
        ("LATE_STATE_AS_CURRENT", good and then and abs(v) > 0.5 and abs(t_late - t) < 1e-9),
        ("PAST_WITH_NEW_DRIVE", good and late_apart and (now or abs(x_late - x) < 0.05 * abs(v))),
        ("FRICTION_LEARNS_BACKWARDS", v > 0.2 and b_ahead - b0 > 1e-9),
        ("SPEED_NOT_CORRECTED", np.max(np.abs(rows[1:6, 2] - v0)) < 1e-9),
        ("SPEED_CORRECTED_BACKWARDS", v_ahead < v0),
        ("SURPRISE_LIMITED", good and 0.8 < abs(rows[5, 1] - x0) / abs(rows[4, 1] - x0) < 1.2),
        ("SPEED_SHARE_OVER_DT", min(gains) > 0.12 and abs(gains[0] - gains[1]) < 0.05 * gains[1]),
    )
    return [code for code, seen in tests if seen]


def of_memory(submission):
    """Whether the same call gives another twin after one in between."""
    return named("GLOBAL_MEMORY") if "GLOBAL_MEMORY" in _in_one_step(submission) else None


def _of_old_position(x, b, usual, soon):
    """Whether a surprise is z minus the position before the prediction, and each correction that much more.

    x, b: position and friction before
    usual, soon: the predicted position, and the states after measurements there and ``_SURPRISE`` ahead
    """
    for place, none, ahead in (usual, soon):
        share, learned = (ahead[[1, 3]] - none[[1, 3]]) / _SURPRISE
        more = (share * (place - x), learned * (place - x))
        off = (none[1] - place - more[0], none[3] - b - more[1])
        if not (0.05 < share < 0.95 and all(abs(o) < 0.03 * abs(m) for o, m in zip(off, more, strict=True))):
            return False
    return True


def _unsurprised(first, ahead, z):
    """The position of a twin whose measurement is the one that it expects; nan if it believes each.

    first, ahead: its positions after measurements at z and ``_SURPRISE`` ahead of it
    """
    share = (ahead - first) / _SURPRISE
    return (first - share * z) / (1 - share) if abs(share - 1) > 0.05 else math.nan


def _driven_at_first(submission):
    """Whether the drive counts for a twin that has not been synchronised yet."""
    calls = [(scenes.new_twin(0.5, drive, speed=1.0), 0.2, 0.2) for drive in (0.5, 4.5)]
    slow, fast = states(submission.call_each("sync", calls))
    return abs(fast[2] - slow[2]) > 0.05 or abs(fast[1] - slow[1]) > 1e-6


def _predicted(twin, b, dt):
    """Where a twin that believes in the friction b expects its cart dt later, m."""
    reach = -math.expm1(-b * dt) / b
    return twin["position"] + twin["speed"] * reach + twin["drive"] * (dt - reach) / b


def _backwards(submission):
    """Whether a twin of a cart that rolls backwards learns the wrong way from a surprise, or either way."""
    if _one_way(submission):
        return "FRICTION_ONE_WAY"
    forwards, backwards = _learned(submission)
    if forwards < -1e-9 and abs(backwards) <= 1e-9:
        return "FRICTION_HELD_BACKWARDS"
    if backwards > -1e-9:
        return None
    return "FRICTION_LEARNS_BACKWARDS" if forwards > 1e-9 else "LEARNS_FORWARDS_ONLY"


def _against_the_drive(submission):
    """Whether a surprise changes the friction the right way only where the drive goes with the motion."""
    calls = [
        (scenes.new_twin(0.5, push * v, speed=v), 0.1 * v + z, 0.1)
        for push in (1.0, -1.0)
        for v in (1.0, -1.0)
        for z in (0.0, _SURPRISE)
    ]
    friction = states(submission.call_each("sync", calls))[:, 3].reshape(2, 2, 2)
    along, against = (friction[..., 1] - friction[..., 0]) * [1.0, -1.0]  # less friction is right forwards
    return "FRICTION_SIGN_OF_DRIVE" if np.all(along < -1e-9) and np.all(against > 1e-9) else None


def _drops_large_ones(submission):
    """Whether a surprise of five stds, either way, changes nothing, and one of half a std does."""
    warm, good = _warm(submission)
    t, x, v, _ = states([warm])[0].tolist()
    calls = [(warm, x + 0.1 * v + n * _SURPRISE, t + 0.1) for n in (0.0, 0.5, 5.0, -5.0)]
    none, small, ahead, behind = states(submission.call_each("sync", calls))
    moved = small[1] - none[1]
    dropped = np.all(ahead == behind) and abs(ahead[1] - none[1]) < abs(moved) and abs(moved) > 1e-6
    return "LARGE_SURPRISES_DROPPED" if good and dropped else None


def _one_way(submission):
    """Whether a new twin's friction moves, and never in both directions for surprises of either sign."""
    calls = [
        (scenes.new_twin(0.57, 0.57 * v, speed=v), 0.1 * v + z, 0.1)
        for v in (1.0, -1.0)
        for z in (0.0, _SURPRISE, -_SURPRISE)
    ]
    none, ahead, behind = states(submission.call_each("sync", calls))[:, 3].reshape(2, 3).T
    moves = np.ravel((ahead - none, behind - none))
    return bool(np.max(np.abs(moves)) > 1e-6 and (np.all(moves > -1e-9) or np.all(moves < 1e-9)))


def _learned(submission):
    """By how much a new twin's friction changes with a surprise, 1/s, rolling forwards and backwards.

    In a Kalman filter it may begin with the second measurement: at first nothing links friction and position.
    """
    new = [scenes.new_twin(0.5, 0.5 * v, speed=v) for v in (1.0, -1.0)]
    for dt in (0.1, 0.2):
        calls = [
            (twin, dt * v + z, dt) for twin, v in zip(new, (1.0, -1.0), strict=True) for z in (0.0, _SURPRISE)
        ]
        twins = submission.call_each("sync", calls)
        friction = states(twins)[:, 3]
        if np.ptp(friction) > 1e-9:
            break
        new = twins[::2]
    return friction[1] - friction[0], friction[3] - friction[2]


def _learning(submission):  # noqa: PLR0911 - one return per mistake
    """From how the friction is learned."""
    twins, _ = _run(submission, 0.5, ((0.0, 0.8),), 12.0)
    friction = states(twins)[:, 3]
    moves = np.ptp(friction)
    if not 1e-9 <= moves < math.inf:  # nan among them
        return "FRICTION_NOT_LEARNED" if moves < 1e-9 else None
    if np.std(friction[-40:]) > 0.03 and _learned(submission)[0] < -_SURPRISE:
        return "FRICTION_SHARE_TOO_LARGE"
    share = _share(submission, twins[-1])
    if share > 0.6:
        # Constant shares do not ask how good a measurement is; a filter that begins afresh each time does.
        constant = abs(_share(submission, {**twins[-1], "sigma": 5 * twins[-1]["sigma"]}) - share) < 1e-6
        dropped = isinstance(twins[-1]["memory"], dict) and not twins[-1]["memory"]
        if constant or dropped:
            return ("SHARE_TOO_LARGE" if share < 1.02 else "SHARE_OVER_ONE") if constant else "MEMORY_DROPPED"
    learned_well = abs(float(np.mean(friction[-20:])) - 0.8) < 0.08  # at first
    slow = None if learned_well or friction.min() <= 0.35 else _too_slow(friction[-40:])
    doubtful = (share > 0.6 or not learned_well) and slow != "FRICTION_LIMITED"
    if doubtful and _memory_unread(submission, twins[-1]):
        return "MEMORY_NOT_READ"
    if not learned_well:
        return slow
    twins, _ = _run(submission, 0.5, ((0.0, 0.5), (30.0, 0.8)), 42.0)
    if np.mean(states(twins[-20:])[:, 3]) >= 0.65:
        return None
    return _drops_large_ones(submission) or "FORGETS_TO_DOUBT"


def _too_slow(friction):
    """Why a friction that started at 0.5 1/s is not at 0.8 1/s yet, if it is on its way."""
    # One that swings far is not slow.
    if not 0.505 < np.mean(friction) < 0.7 or np.std(friction) > 0.1:
        return None
    return "FRICTION_LIMITED" if stops(friction, -1) else "FRICTION_LEARNS_SLOWLY"


def _limit(submission):
    """Whether an unusual friction is learned up to one number, or down to one, and no further."""
    for right, end in ((1.3, -1), (0.35, 0)):
        twins, _ = _run(submission, 0.6, ((0.0, right),), 15.0)
        friction = states(twins)[-40:, 3]
        if abs(float(np.mean(friction)) - right) > 0.06 and stops(friction, end):
            return "FRICTION_LIMITED"
    return None


def stops(friction, end):
    """Whether the largest number (end -1) or the smallest (0) comes back, and no other one.

    What is learned from noisy measurements never comes to the same number twice, a limit does.
    """
    apart, times = np.unique(friction, return_counts=True)
    return bool(len(apart)) and times[end] >= 3 and len(apart) == len(friction) - times[end] + 1


def _memory_unread(submission, twin):
    """Whether a twin has a memory, and forgetting it makes no difference to the next call."""
    if not (isinstance(twin["memory"], dict) and twin["memory"]):
        return False
    t, x, v, _ = states([twin])[0].tolist()
    asked = ((x + 0.2 * v + _SURPRISE, t + 0.2), (x - 0.2 * v + _SURPRISE, t - 0.2))  # new, and late
    calls = [({**twin, "memory": memory}, *each) for memory in (twin["memory"], {}) for each in asked]
    held, empty = np.split(states(submission.call_each("sync", calls)), 2)
    return bool(np.all(np.abs(held - empty) < 1e-12))


def _share(submission, twin):
    """What share of a surprise the position is moved by; constant ones are small and need no memory."""
    t, x, v, _ = states([twin])[0].tolist()
    calls = [(twin, x + 0.2 * v + surprise, t + 0.2) for surprise in (0.0, _SURPRISE)]
    expected, ahead = states(submission.call_each("sync", calls))[:, 1]
    return (ahead - expected) / _SURPRISE


#: 1/s, the README's, with room for rounding. With a command every 0.1 s a correction by 20 never settles.
LARGEST_GAIN = 3.0 * (1 + 1e-6)
#: m/s; so near to the target speed a correction is nearly zero.
_NEXT = 0.01


@np.errstate(all="ignore")  # a submission may have returned anything
def of_command(submission):
    """The mistake that ``command`` makes, from what its answer depends on."""
    base = {"friction": 0.8, "drive": 0.3, "speed": 1.5, "target": 1.5}
    tries = [
        base,
        base | {"target": 0.75, "speed": 0.75},
        base | {"friction": 0.4},
        base | {"target": -1.5, "speed": -1.5},
        base | {"drive": 0.5},
        base | {"target": 3.0},
        base | {"speed": 0.75},
        base | {"target": 0.1, "speed": 0.1},
        base | {"friction": 2.0},
        base | {"friction": 2.0, "target": 3.0},
        base | {"friction": 2.0, "target": 2.0, "speed": 2.0},
        base | {"friction": 0.4, "target": 0.2, "speed": 0.5},
        base | {"target": 6.0, "speed": 6.0},
        base | {"target": -6.0, "speed": -6.0},
        base,
        base | {"speed": 1.5 - _NEXT},
        base | {"speed": 1.5 + _NEXT},
    ]
    calls = [
        (scenes.new_twin(case["friction"], case["drive"], speed=case["speed"]), case["target"])
        for case in tries
    ]
    values = [kit.as_number(value, "the drive") for value in submission.call_each("command", calls)]
    first, slower, slick, back, driven, faster, behind, slowest, sticky, sticky_faster = values[:10]
    stickiest, ahead, far, far_back, again, near, beyond = values[10:]
    if abs(again - first) > 1e-9:
        return None  # what came before has an effect: nothing else can be told from one call beside another
    # A correction by the friction itself, at one friction, looks as if the target were not looked at.
    untargeted = max(abs(faster - first), abs(sticky_faster - sticky), abs(ahead - 0.4 * 0.5)) < 1e-9
    at_target = np.array([first, slower, slick, back, slowest, sticky, stickiest, far, far_back])
    balance = _FRICTIONS * _TARGETS
    balanced = np.max(np.abs(at_target - balance)) < 1e-9
    limits = float(np.min(at_target)), float(np.max(at_target))
    cut_off = limits[0] < -1e-9 and limits[1] > 0.08 + 1e-9 and np.max(np.abs(at_target - balance)) > 1e-9
    tests = (
        ("BALANCE_MISSING", np.max(np.abs([first, slower, slick, back, slowest, sticky])) < 1e-9),
        ("BRAKES", first < 0 and slower < 0 and back > 0),
        ("ADDS_CURRENT_DRIVE", abs(driven - first) > 1e-9),
        ("DRIVE_LIMITED", cut_off and np.max(np.abs(np.clip(balance, *limits) - at_target)) < 1e-9),
        ("USES_TWIN_SPEED", untargeted and abs(slower - first) > 1e-9),
        ("TARGET_IGNORED", max(abs(slower - first), abs(slowest - first), abs(faster - first)) < 1e-9),
        ("FRICTION_IGNORED", max(abs(slick - first), abs(sticky - first)) < 1e-9),
        ("DIVIDES_BY_FRICTION", slick > first > sticky),
        *_laws(at_target),
        ("BACKWARDS_NOT_DRIVEN", back > -1e-9 and first > 1e-9),
        ("PUSHES_AWAY", behind < first - 1e-9 or (balanced and sticky_faster < 2.0 * 3.0 - 1e-9)),
        ("CORRECTION_JUMPS", min(near - first, first - beyond) > max(0.5 * (behind - first), 1e-9)),
        (
            "GAIN_TOO_LARGE",
            behind - first > LARGEST_GAIN * 0.75 or near - first > LARGEST_GAIN * _NEXT + 1e-9,
        ),
    )
    return next((named(code) for code, seen in tests if seen), None)


#: Of the questions whose twin has the target speed already, in the order of ``of_command``.
_FRICTIONS = np.array([0.8, 0.8, 0.4, 0.8, 0.8, 2.0, 2.0, 0.8, 0.8])
_TARGETS = np.array([1.5, 0.75, 1.5, -1.5, 0.1, 1.5, 2.0, 6.0, -6.0])


def _laws(drives):
    """Codes of other laws, and whether drives at the target speed follow them: no correction is in these."""
    factor = drives / (_FRICTIONS * _TARGETS)
    return (
        ("TARGET_SQUARED", np.allclose(drives, _FRICTIONS * _TARGETS * np.abs(_TARGETS), rtol=0, atol=1e-9)),
        ("FRICTION_SQUARED", np.allclose(drives, _FRICTIONS**2 * _TARGETS, rtol=0, atol=1e-9)),
        ("DRIVE_OFF_BY_FACTOR", np.ptp(factor) < 1e-9 < abs(factor[0] - 1) and factor[0] > 0),
    )
