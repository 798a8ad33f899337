"""What the path of a simulation of ``collisions`` shows of the mistake behind it.

When a path bends, how fast it goes on, and how it ends: of families of mistakes, as in ``probes.py``.
"""

from __future__ import annotations

import math

import numpy as np

from course.scoring import kit

_probes = kit.companion("collisions", "probes")
named = _probes.named

#: What restitution may have become, as a share of the speed of approach.
_PARTINGS = (
    ("RESTITUTION_SQUARED", lambda e: e * e),
    ("RESTITUTION_AS_ENERGY", math.sqrt),
    ("RESTITUTION_IGNORED", lambda e: 1.0),
    ("RESTITUTION_IGNORED", lambda e: 0.0),
    ("ONLY_THE_REBOUND", lambda e: e - 1),
    ("RESTITUTION_SIGN_FLIPPED", lambda e: -e),
)

# -- the head-on simulation -----------------------------------------------------------------------------


@np.errstate(all="ignore")
def of_head_on(scene, truth, t, x, v, h):
    """What a head-on path of the right length does instead. truth: ``paths.Meeting``; x, v: shape (n, 2)."""
    if np.isnan(x).any() or np.isnan(v).any():
        return named("INFINITE_MASS_NAN") if math.inf in scene.m else None
    if _nearly(t, x, v, scene.at(t, truth.contact, truth.after), [truth.contact]):
        return named("PRECISION_LOST")
    if not np.allclose(x[0], scene.x0, rtol=1e-9, atol=1e-9) or not np.allclose(
        v[0], scene.v0, rtol=1e-9, atol=1e-9
    ):
        return named(_first_row((x, v), scene.x0, scene.at([h], truth.contact, truth.after)[0][0], scene.v0))
    if not x[-1].any() and not v[-1].any():  # balls with radii are not both at 0
        return named("ROWS_NOT_WRITTEN")
    straight, _ = scene.at(t, math.inf, None)
    if np.allclose(x, straight, rtol=1e-9, atol=1e-9) and truth.contact < t[-1]:
        # Scenes that meet later come before, and were right.
        return named("FIRST_STEP_MISSED" if truth.contact < h else "PASSES_THROUGH")
    code = _of_meeting(scene, truth, t, x, v, h)
    return named(code) if code else None


def _of_meeting(scene, truth, t, x, v, h):
    """What goes wrong after a right start, other than that nothing happens."""
    if truth.contact == math.inf:  # they part from the start
        blows = int(np.any(np.abs(np.diff(v, axis=0)) > 1e-9, axis=1).sum())
        return "IMPULSE_ON_SEPARATING" if 0 < blows < len(v) // 4 else None
    if np.allclose(x, scene.at(t, truth.contact, truth.after)[0], rtol=1e-9, atol=1e-8):
        return _of_timing(scene, truth, t, x, v, h)
    if not np.allclose(v[-1], truth.after, rtol=1e-9, atol=1e-8):
        before = t < truth.contact - 1e-9
        came = np.allclose(x[before], scene.at(t, math.inf, None)[0][before], rtol=1e-9, atol=1e-8)
        return _of_speeds(scene, v, came)
    return _of_timing(scene, truth, t, x, v, h)


def _nearly(t, x, v, path, contacts):
    """Whether a path is the right one but for a rounding: to six digits, or to single precision."""
    away = np.all(
        np.abs(t[:, None] - np.array(contacts)) > 1e-6, axis=1
    )  # where it falls on a sample, v may be either
    pairs = ((x, path[0]), (v[away], path[1][away]))
    return all(np.allclose(found, true, rtol=1e-6, atol=1e-6) for found, true in pairs)


def _first_row(states, start, later, speeds):
    """What a path holds in its first row, which is not the initial state. later: where it is one step on."""
    x, v = states
    if np.array_equal(np.ravel(x[0]), np.ravel(speeds)) and np.array_equal(np.ravel(v[0]), np.ravel(start)):
        return "HISTORIES_SWAPPED"
    same = all(np.array_equal(rows, np.broadcast_to(rows[-1], rows.shape)) for rows in states)
    if len(x) > 2 and same and not np.allclose(x[0], start):
        return "ROWS_ALL_THE_SAME"
    missing = np.allclose(x[0], later, rtol=1e-9, atol=1e-8) or not np.any(x[0])
    return "INITIAL_STATE_MISSING" if missing else "INITIAL_STATE_WRONG"


def _of_speeds(scene, v, came):
    """The velocities at the end are wrong ones: which? came: whether all is right until the contact."""
    impacts = np.flatnonzero(np.any(np.abs(np.diff(v, axis=0)) > 1e-9, axis=1))
    if len(impacts) > 1 and v[impacts[1], 0] <= v[impacts[1], 1]:  # the second one while they move apart
        return "IMPULSE_ON_SEPARATING"
    if math.inf in scene.m:
        return None
    kept = abs(float(np.dot(scene.m, v[-1] - scene.v0))) < 1e-8 * float(np.dot(scene.m, np.abs(scene.v0)))
    if kept:
        after = v[impacts[0] + 1] if len(impacts) else v[-1]  # later impacts may hide what the first one does
        parting = (after[1] - after[0]) / (scene.v0[0] - scene.v0[1])
        same = (
            c
            for c, becomes in _PARTINGS
            if math.isclose(parting, becomes(scene.restitution), rel_tol=1e-8, abs_tol=1e-9)
        )
        codes = set(same)
        # Without total momentum any multiple of the velocities keeps it: the sign may be lost elsewhere.
        still = abs(float(np.dot(scene.m, scene.v0))) < 1e-8 * float(np.dot(scene.m, np.abs(scene.v0)))
        if came and len(codes) == 1 and not (still and parting < 0):  # where e is 0 or 1, several look alike
            return codes.pop()
    if _probes.energy(*scene.m, *v[-1]) > _probes.energy(*scene.m, *scene.v0) * (1 + 1e-9):
        return "ENERGY_CREATED"
    return None if kept else "MOMENTUM_LOST"


def _of_timing(scene, truth, t, x, v, h):
    """The velocities are right in the end: when did they change, and how long did the balls go on?"""
    path = scene.at(t, truth.contact, truth.after)[0]
    if np.allclose(x, path, rtol=1e-9, atol=1e-8):
        first = (t > truth.contact + 1e-9) & (t <= truth.contact + h + 1e-9)
        rest = np.where(t[:, None] <= truth.contact, scene.v0, truth.after)[~first]
        late = np.allclose(v[first], scene.v0, rtol=1e-9, atol=1e-8) and np.allclose(
            v[~first], rest, rtol=1e-9, atol=1e-8
        )
        return "VELOCITIES_LATE" if late else "VELOCITIES_APART"
    later = t > truth.contact + h + 1e-9
    off = (x - path)[later]
    if not len(off) or not np.allclose(off, off[0], rtol=1e-9, atol=1e-8):
        return None
    # Another moment of the impact moves each ball by its change of velocity, another rest of the step
    # by its velocity after it.
    before, after = np.array(scene.v0), np.array(truth.after)
    delay, shift = _share(off[0], before - after), _share(off[0], after)
    if delay is not None:
        at = (truth.contact + delay) / h
        sample = delay > 0 and math.isclose(at, round(at), abs_tol=1e-6)
        if not math.floor(truth.contact / h) <= at + 1e-6 <= math.ceil(truth.contact / h) + 2e-6:
            return None  # in another step
        return "IMPACT_AT_SAMPLE" if sample else "MOMENT_IN_STEP_WRONG"
    return None if shift is None else "TIME_LEFT_WRONG"


def _share(off, way):
    """How often ``way`` fits into ``off``; None if they do not lie along one another, or nothing is off."""
    share = float(off @ way) / (float(way @ way) or 1.0)
    fits = np.allclose(off, share * way, rtol=1e-9, atol=1e-8) and abs(share) > 1e-9
    return share if fits else None


# -- the drop -------------------------------------------------------------------------------------------


@np.errstate(all="ignore")
def of_drop(scene, truth, t, z, v, h):
    """What a path of the right length does instead. truth: ``paths.Bounces``; z, v: shape (n,)."""
    if not np.all(np.isfinite(z)) or not np.all(np.isfinite(v)):
        return None
    if _nearly(t, z, v, scene.at(t, truth.times, truth.speeds), truth.times):
        return named("PRECISION_LOST")
    if not math.isclose(z[0], scene.z0, abs_tol=1e-9) or not math.isclose(v[0], scene.v0, abs_tol=1e-9):
        later = scene.at([h], truth.times, truth.speeds)[0][0]
        return named(_first_row((z[:, None], v[:, None]), scene.z0, later, scene.v0))
    code = (
        _drop_empty(scene, truth, t, z, v)
        or _drop_hangs(scene, truth, t, z, v, h)
        or _drop_start(scene, truth, t, z, v, h)
        or _drop_later(scene, truth, t, z, v)
    )
    return named(code) if code else None


def _drop_empty(scene, truth, t, z, v):
    """Whether the last rows hold zeros, which are no rest on a floor at another height."""
    filled = np.flatnonzero((z != 0.0) | (v != 0.0))
    if len(filled) == len(z) or not len(filled) or filled[-1] == len(z) - 1:
        return None
    last = filled[-1]
    rests = v[last] == 0.0 and math.isclose(z[last], scene.radius, abs_tol=1e-9)
    return "ROWS_NOT_WRITTEN" if rests or t[last + 1] < truth.may else None


def _drop_hangs(scene, truth, t, z, v, h):
    """Whether all is right until the ball is slow in the air, and from there on it does not move."""
    path, speed = scene.at(t, truth.times, truth.speeds)
    off = np.abs(z - path) > 1e-8
    k = int(np.argmax(off))
    if not off.any() or t[k] > truth.may or z[k] < scene.radius + 1e-6:
        return None
    still = np.all(z[k:] == z[k - 1]) and np.all(v[k:] == 0.0)
    return "RESTS_IN_THE_AIR" if still and abs(speed[k - 1]) <= 2 * scene.g * h else None


def _drop_start(scene, truth, t, z, v, h):
    """What is wrong all along, or before the first contact, or if there is none."""
    before = t < (truth.times[0] if truth.times else math.inf)
    fall = scene.z0 + scene.v0 * t - scene.g * t * t / 2
    off = z - fall
    if before.sum() > 2 and not np.allclose(off[before], 0.0, rtol=1e-9, atol=1e-8):
        return _drop_flight(scene, t, z, v, h, before, off) or _drop_early(scene, z, v, off)
    path, _ = scene.at(t, truth.times, truth.speeds)
    if np.allclose(z, path, rtol=1e-9, atol=1e-8) and not np.allclose(
        v[before], (scene.v0 - scene.g * t)[before], rtol=1e-9, atol=1e-8
    ):
        return "VELOCITIES_APART"
    if np.allclose(z, fall, rtol=1e-9, atol=1e-8):
        return "FALLS_THROUGH_FLOOR"
    soon = truth.times and truth.times[0] < h and scene.v0 > 0
    flies = soon and z[1] < scene.radius - 1e-9 and math.isclose(z[1], fall[1], abs_tol=1e-9)
    return "SHORT_HOP_MISSED" if flies else None


def _drop_later(scene, truth, t, z, v):
    """What is wrong from the first contact on."""
    return (
        _drop_speeds(scene, truth, t, z, v)
        or _drop_late(scene, truth, t, z, v)
        or _drop_again(scene, truth, t, z)
        or _drop_rebound(scene, truth, t, z, v)
        or _drop_end(scene, truth, t, z, v)
        or _drop_impact(scene, truth, t, z, v)
        or _drop_too_low(scene, truth, t, z)
    )


def _drop_flight(scene, t, z, v, h, before, off):
    """What is wrong before the first contact."""
    if scene.v0 > 0 and scene.z0 == scene.radius:
        if np.all(z[before] <= scene.radius + 1e-9):
            return "LAUNCH_IGNORED"
        if math.isclose(v[1], scene.restitution * scene.v0 - scene.g * h, abs_tol=1e-8):
            return "LAUNCH_IS_BOUNCE"
    drift = np.abs(np.abs(off) - scene.g * h * t / 2)
    turned = np.flatnonzero(np.diff(v) > 0)  # with its error it comes to the floor earlier, or later
    own = before & (np.arange(len(t)) <= turned[0]) if len(turned) else before
    if own.sum() > 2 and np.all(drift[own] < 1e-6):
        return "EULER_IN_FLIGHT"
    last = int(np.flatnonzero(before)[-1])
    share = off[last] / t[last]  # what is off grows with t, by g/2 times a step
    parts = scene.g * h / 2 / abs(share) if share else 0.0
    # A wrong factor of h² is off in the same way, by more.
    whole = 9.5 < parts < 1e4 and abs(parts - round(parts)) < 1e-3
    if whole and np.allclose(off[before], share * t[before], rtol=0, atol=1e-9):
        return "EULER_IN_PARTS"
    g = (scene.v0 - v[1]) / h
    path = scene.z0 + scene.v0 * t - g * t * t / 2
    early = before & (t <= 4 * h)  # with its own g it may come to the floor before
    other = early.sum() > 2 and np.allclose(z[early], path[early], rtol=0, atol=1e-9)
    return "OTHER_GRAVITY" if other and not math.isclose(g, scene.g, rel_tol=1e-6) else None


def _drop_early(scene, z, v, off):
    """Heights are wrong before the first contact: because the ball has bounced already, or in its flight."""
    k = int(np.argmax(np.abs(off) > 1e-8))
    if math.isclose(z[k], scene.radius, abs_tol=1e-9):
        return "DOWN_TOO_SOON"
    turns = (v[:k] < -1e-9) & (v[1 : k + 1] >= 0.0)
    return "FLOOR_TOO_HIGH" if turns.any() else "FLIGHT_WRONG"


def _drop_late(scene, truth, t, z, v):
    """Whether the first bounce comes at the sample after its contact, with the speed that the ball has there.

    Samples on which a contact falls, and bounces after which it rests, say nothing.
    """
    if not truth.times or not truth.speeds[0]:
        return None
    k = int(np.searchsorted(t, truth.times[0]))
    if k >= len(t) or t[k] - truth.times[0] < 1e-9:
        return None
    down = scene.v0 - scene.g * t[k]
    fallen = scene.z0 + scene.v0 * t[k] - scene.g * t[k] ** 2 / 2
    there = math.isclose(z[k], fallen, abs_tol=1e-9) or math.isclose(z[k], scene.radius, abs_tol=1e-9)
    turned = math.isclose(v[k], -down * scene.restitution, rel_tol=1e-8)
    # One that turns a step later may also have met a floor at another height.
    turns = k + 1 < len(v) and math.isclose(v[k], down, rel_tol=1e-8) and _turned(v[k + 1], down, scene, t[1])
    return "IMPACT_AT_SAMPLE" if there and (turned or turns) else None


def _turned(speed, down, scene, h):
    """Whether a speed is that of a ball turned at the sample before, or at this one."""
    e, g = scene.restitution, scene.g
    return any(math.isclose(speed, up, rel_tol=1e-8) for up in (-e * down - g * h, -e * (down - g * h)))


def _drop_again(scene, truth, t, z):
    """Whether a ball that is back within the step of its bounce is in the floor at the end of that step."""
    speed = scene.fastest
    for moment, up in zip(truth.times, truth.speeds, strict=True):
        k, speed = int(np.searchsorted(t, moment + 1e-9)), speed * scene.restitution
        left = t[k] - moment if k < len(t) else 0.0
        below = speed * left - scene.g * left**2 / 2
        if below < -1e-8:
            return "ONE_BOUNCE_A_STEP" if math.isclose(z[k], scene.radius + below, abs_tol=1e-9) else None
        speed = up
    return None


def _drop_rebound(scene, truth, t, z, v):
    """The share of its speed with which the ball leaves its first contact, if that is a known wrong one."""
    if len(truth.times) < 1 or not truth.speeds[0]:
        return None
    speed = truth.speeds[0]
    k = int(np.searchsorted(t, truth.times[0]))
    up = v[k] + scene.g * (t[k] - truth.times[0]) if k < len(t) else 0.0  # from the contact on
    if up <= 0.0 or z[k] < scene.radius - 1e-9:
        return None
    rebound = math.sqrt(max(v[k] ** 2 + 2 * scene.g * (z[k] - scene.radius), 0.0)) / scene.fastest
    if math.isclose(rebound * scene.fastest, speed, rel_tol=1e-8):
        return None
    e, g = scene.restitution, scene.g
    gains = [factor * g * (z[k - 1] - scene.radius) for factor in (0.5, 1.0)] if k else []
    squares = [
        ("SPEED_AT_STEP_END", (scene.v0 - g * t[k]) ** 2),
        ("SPEED_AT_STEP_START", v[max(k - 1, 0)] ** 2),
        ("FALLS_TO_ZERO", scene.fastest**2 + 2 * g * scene.radius),
        *(("FALL_WITHOUT_TWO", v[k - 1] ** 2 + gain) for gain in gains),
    ]
    for code, square in squares:
        if math.isclose(rebound * scene.fastest, e * math.sqrt(max(square, 0.0)), rel_tol=1e-8):
            return code
    names = (code for code, becomes in _PARTINGS[:3] if math.isclose(rebound, becomes(e), rel_tol=1e-8))
    return next(names, None)


def _drop_speeds(scene, truth, t, z, v):
    """Whether all is right but velocities: where the ball lies on the floor, or elsewhere."""
    path, speed = scene.at(t, truth.times, truth.speeds)
    lies = (np.abs(z - scene.radius) < 1e-9) & (speed == 0.0) & (t > truth.may + 1e-7)
    near = np.any(np.abs(t[:, None] - np.array(truth.times)) < 1e-7, axis=1)
    if not np.allclose(z, path, rtol=1e-9, atol=1e-8):
        return None
    if not np.allclose(v[~lies & ~near], speed[~lies & ~near], rtol=1e-9, atol=1e-8):
        return "VELOCITIES_APART"
    return "REST_KEEPS_SPEED" if np.any(v[lies] != 0.0) else None


def _drop_end(scene, truth, t, z, v):
    """How it ends, if it goes right until it may rest."""
    path = scene.at(t, truth.times, truth.speeds)[0]
    wrong = np.flatnonzero(np.abs(z - path) > 1e-8)
    rests = np.abs(z - scene.radius) < 1e-9
    if len(wrong) and t[wrong[0]] < truth.may:
        still = rests[wrong[0] :].all() and np.all(v[wrong[0] :] == 0.0)
        return "RESTS_TOO_EARLY" if still else None
    late = t > truth.must + 1e-9
    if not late.any():
        return None
    if np.all(v[late] == 0.0) and np.all(z[late] == z[-1]) and not rests[-1]:
        return "RESTS_ELSEWHERE"
    if np.any(z[late] < scene.radius - 1e-9) and z[-1] < scene.radius - 1e-6:
        return "SINKS_THROUGH_FLOOR"
    if rests[late].all() and np.any(v[late] != 0.0):
        return "REST_KEEPS_SPEED"
    return "RESTING_JITTER" if np.any(~rests[late]) else None


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
    if np.max(total[k:]) > start * (1 + 1e-6):
        return "GAINS_ENERGY"
    # The ball left the floor at the speed it should: for how long has it flown?
    up = truth.speeds[0]
    left = (up - v[k]) / scene.g
    # Of a ball that loses nothing, a floor at another height shows in the same way.
    flies = 0.0 < up < 0.999 * scene.fastest and math.isclose(
        z[k], scene.radius + up * left - scene.g * left**2 / 2, abs_tol=1e-8
    )
    # A velocity of the wrong sign is that of a much longer flight.
    flies = flies and abs(left) <= 2 * t[1]
    return "TIME_LEFT_WRONG" if flies and abs(left - (t[k] - truth.times[0])) > 1e-8 else None


def _drop_too_low(scene, truth, t, z):
    """Whether the ball is in the floor at the first sample with a wrong height, whose numbers are printed."""
    off = np.abs(z - scene.at(t, truth.times, truth.speeds)[0]) > 1e-8
    low = z[int(np.argmax(off))] < scene.radius - 1e-8
    return "IN_THE_FLOOR" if off.any() and low else None


# -- samples --------------------------------------------------------------------------------------------


def of_count(rows, t_end, h, parts):
    """What gives ``rows`` samples for a duration. parts: times and both histories, in any form."""
    exact = t_end / h
    t, *shapes = kit.as_vector(parts[0]), *(kit.attempt(lambda p=part: np.shape(p)) for part in parts[1:])
    n = round(exact) + 1
    if all(shape == (2, n) for shape in shapes) and n != 2:
        return named("HISTORIES_TRANSPOSED")
    if len(t) != n and all(shape and shape[0] == n for shape in shapes):
        return named("TIMES_NOT_AS_ROWS")
    if rows and len(t) and math.isclose(float(t[0]), h, rel_tol=1e-9):
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
    # A running sum of h is right to a billionth: rounded, or in single precision, they are not.
    return named("PRECISION_LOST") if np.allclose(t, h * np.arange(len(t)), rtol=1e-6, atol=1e-6) else None
