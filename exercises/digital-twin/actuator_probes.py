"""Finding out which mistake an actuator or the odometry of ``digital-twin`` makes.

Formulas that are often written instead are tried on one call where every argument matters; whichever gives
what the submission gives is named.
"""

from __future__ import annotations

import math

import numpy as np

from course.grading import kit

named = kit.companion("digital-twin", "diagnosis").named


def _clip(u, limit):
    return min(max(u, -limit), limit)


# -- motor ----------------------------------------------------------------------------------------------

_DT, _TAU, _U_MAX, _DEAD = 0.3, 0.5, 10.0, 2.0
_GONE = 1 - math.exp(-_DT / _TAU)
#: w, u: a usual step, backwards, too large both ways, swallowed both ways, at the edge, w beyond u_max
_MOTOR = (
    (1.0, 6.0),
    (1.0, -6.0),
    (1.0, 14.0),
    (1.0, -14.0),
    (4.0, 1.5),
    (4.0, -1.5),
    (4.0, 2.0),
    (30.0, 5.0),
)


def _motor(w, u, share=_GONE, keep=None, clip=_clip):
    u = (keep or (lambda u: 0.0 if abs(u) <= _DEAD else u))(u)
    return w + share * (clip(u, _U_MAX) - w)


def _motor_slips():
    """(code, what it gives for each of ``_MOTOR``)."""

    def row(**slip):
        return [_motor(w, u, **slip) for w, u in _MOTOR]

    yield "LAG_EULER_UNSTABLE", row(share=_DT / _TAU)
    yield "LAG_EULER_UNSTABLE", row(share=min(_DT / _TAU, 1.0))
    yield "LAG_IMPLICIT", row(share=_DT / (_TAU + _DT))
    yield "LAG_INVERTED", row(share=1 - _GONE)
    yield "LAG_MISSING", row(share=1.0)
    unlimited = row(clip=lambda u, _limit: u)
    yield "CLIPS_SPEED_NOT_COMMAND", [_clip(w, _U_MAX) for w in unlimited]
    yield "CLIPS_SPEED_NOT_COMMAND", [_clip(w, _U_MAX) for w in row()]
    yield "CLIPS_SPEED_NOT_COMMAND", [_motor(_clip(w, _U_MAX), u) for w, u in _MOTOR]
    yield "SATURATION_MISSING", unlimited
    yield "SATURATION_ONE_SIDED", row(clip=min)
    yield "DEADBAND_MISSING", row(keep=lambda u: u)
    yield "DEADBAND_ONE_SIDED", row(keep=lambda u: 0.0 if u <= _DEAD else u)
    yield "DEADBAND_ONE_SIDED", row(keep=lambda u: 0.0 if 0 <= u <= _DEAD else u)
    yield "DEADBAND_SUBTRACTED", row(keep=lambda u: math.copysign(max(abs(u) - _DEAD, 0.0), u))
    yield "DEADBAND_EDGE", row(keep=lambda u: 0.0 if abs(u) < _DEAD else u)
    for stuck in (0.0, 1.0):
        yield (
            "DEADBAND_STOPS_MOTOR",
            [stuck * w if abs(u) <= _DEAD else _motor(w, u) for w, u in _MOTOR],
        )


@np.errstate(all="ignore")  # a submission may have returned anything
def of_motor(submission):
    """The mistake that ``motor_step`` makes."""
    values = submission.call_each("motor_step", [(w, u, _DT, _TAU, _U_MAX, _DEAD) for w, u in _MOTOR])
    values = [kit.as_number(value, "w_next") for value in values]
    # With several mistakes at once: the first call has neither dead band nor saturation in it.
    lags = [(code, row[:1]) for code, row in _motor_slips() if code.startswith("LAG")]
    found = _matching(values, _motor_slips()) or _matching(values[:1], lags)
    if found:
        return found
    brief, long = (
        kit.as_number(value, "w_next")
        for value in submission.call_each(
            "motor_step", [(1.0, 6.0, dt, 0.5, 10.0, 2.0) for dt in (0.01, 1.0)]
        )
    )
    return named("LAG_WITHOUT_DT") if brief == long else None


def _matching(values, slips):
    """The first slip that gives exactly these values."""
    for code, expected in slips:
        if np.allclose(values, expected, rtol=1e-9, atol=1e-12):
            return named(code)
    return None


# -- backlash -------------------------------------------------------------------------------------------

#: x, state, for a gap of 1: inside the play, beyond either side, near zero, far off, exactly at the edge
_PLAY = (
    (0.3, 0.1),
    (0.9, 0.0),
    (-0.9, 0.0),
    (0.2, 1.4),
    (0.2, -1.4),
    (5.0, 4.8),
    (5.0, 1.0),
    (-2.0, -2.4),
    (1.5, 1.0),
)


def _play_slips():
    """(code, y for each of ``_PLAY``)."""

    def row(rule):
        return [rule(x, state) for x, state in _PLAY]

    def right(x, s, half=0.5):
        return min(max(s, x - half), x + half)

    yield "GAP_DOUBLED", row(lambda x, s: right(x, s, 1.0))
    yield "GAP_HALVED", row(lambda x, s: right(x, s, 0.25))
    yield "BACKLASH_MISSING", row(lambda x, _s: x)
    yield "BACKLASH_IS_DEAD_BAND", row(lambda x, _s: x - _clip(x, 0.5))
    yield "BACKLASH_IS_DEAD_BAND", row(lambda x, _s: 0.0 if abs(x) <= 0.5 else x)
    yield "BACKLASH_SNAPS", row(lambda x, s: s if abs(x - s) <= 0.5 else x)
    yield "BACKLASH_ONE_SIDED", row(lambda x, s: max(s, x - 0.5))
    yield "BACKLASH_ONE_SIDED", row(lambda x, s: min(s, x + 0.5))


@np.errstate(all="ignore")  # a submission may have returned anything
def of_backlash(submission):
    """The mistake that ``backlash`` makes in single calls from known states."""
    values = submission.call_each("backlash", [(x, 1.0, state) for x, state in _PLAY])
    pairs = [kit.as_tuple(value, ("y", "state_next")) for value in values]
    outputs = [kit.as_number(y, "y") for y, _ in pairs]
    found = _matching(outputs, _play_slips())
    if found:
        return found
    if _remembers(submission):
        return named("STATE_IN_MODULE")
    right = [min(max(s, x - 0.5), x + 0.5) for x, s in _PLAY]
    if np.allclose(outputs, right, rtol=0, atol=1e-12):
        states = [kit.as_number(state, "state_next") for _, state in pairs]
        return None if np.allclose(states, outputs, rtol=0, atol=1e-12) else named("STATE_IS_NOT_OUTPUT")
    # What it covers of the way to the edge of the gap is neither none nor all: it is a lag.
    shares = [
        (y - s) / (r - s) for y, r, (_, s) in zip(outputs, right, _PLAY, strict=True) if abs(r - s) > 1e-9
    ]
    return named("BACKLASH_RATE_DEPENDENT") if all(0 < share < 1 for share in shares) else None


def _remembers(submission):
    """Whether one and the same call gives something else after another call."""
    far = (-9.0, 1.0, -9.0), (9.0, 1.0, 9.0)
    values = submission.call_each("backlash", [far[0], (0.3, 1.0, 0.1), far[1], (0.3, 1.0, 0.1)])
    first, again = (kit.as_number(kit.as_tuple(values[i], ("y", "state_next"))[0], "y") for i in (1, 3))
    return first != again and not (math.isnan(first) and math.isnan(again))


# -- delay ----------------------------------------------------------------------------------------------


@np.errstate(all="ignore")  # a submission may have returned anything
def of_delay(value, x, dt, latency):
    """The mistake behind a delayed signal."""
    t = dt * np.arange(len(x))
    samples = latency / dt
    looks = [
        ("DELAY_HOLDS_FIRST", np.interp(t - latency, t, x)),
        ("DELAY_ADVANCES", np.interp(t + latency, t, x)),
        ("DELAY_ADVANCES", np.interp(t + latency, t, x, right=0.0)),
        ("DELAY_RAMPS_IN", np.interp(t - latency, np.append(-dt, t), np.append(0.0, x), left=0.0)),
        ("DELAY_IN_SAMPLES", np.interp(t - latency * dt, t, x, left=0.0)),
    ]
    for whole in {math.floor(samples), round(samples), math.ceil(samples)}:
        shifted = np.concatenate((np.zeros(whole), x))[: len(x)]
        looks.append(("DELAY_WHOLE_SAMPLES", shifted))
        looks.append(("DELAY_WHOLE_SAMPLES", np.concatenate((np.full(whole, x[0]), x))[: len(x)]))
        looks.append(("DELAY_WRAPS", np.roll(x, whole)))
    looks.append(("DELAY_WRAPS", np.interp(t - latency, t, x, period=dt * len(x))))
    return _matching(value, looks)


# -- differential drive ---------------------------------------------------------------------------------

#: Numbers of no pattern, or one mistake gives what another does: with right = 3 left, the sum of both is
#: twice their difference.
_POSE, _LEFT, _RIGHT, _TRACK, _STEP = (1.0, 2.0, 2.5), 0.31, 0.83, 0.47, 1.3
#: Where in the turn the heading of the way is taken, and whether the way is the chord: right, and as by Euler
_WAYS = ((0.5, True), (0.0, False), (1.0, False), (0.5, False))


def _arc(left=_LEFT, right=_RIGHT, track=_TRACK, at=0.5, chord=True, reach=1.0, **slip):
    """One step; ``at`` is where in the turn the heading of the way is taken.

    slip: functions of the ``turn`` and of the ``angle`` that cosine and sine are taken of; the ``sinc`` of
        the turn; whether cosine and sine are ``swapped``
    """
    turn = slip.get("turn", lambda turn: turn)((right - left) / track * _STEP)
    sinc = slip.get("sinc", lambda turn: np.sinc(turn / (2 * np.pi)))
    way = reach * (left + right) / 2 * _STEP * (sinc(turn) if chord else 1.0)
    angle = slip.get("angle", lambda angle: angle)(_POSE[2] + at * turn)
    x, y = (way * math.cos(angle), way * math.sin(angle))[:: -1 if slip.get("swapped") else 1]
    return np.array([_POSE[0] + x, _POSE[1] + y, _POSE[2] + turn])


@np.errstate(all="ignore")  # a submission may have returned anything
def of_drive(submission):
    """The mistake that ``diff_drive_step`` makes: one turn, and where that is right, ever slower ones."""
    value = kit.as_vector(submission.call("diff_drive_step", _POSE, _LEFT, _RIGHT, _TRACK, _STEP), 3, "pose")
    right = _arc()
    found = _matching(value, (("HEADING_WRAPPED", _wrapped(right)), *_drive_slips()))
    if found or not np.allclose(value, right, rtol=1e-9, atol=1e-12):
        return found
    return kit.attempt(lambda: _of_slow_turns(submission))


def _wrapped(pose):
    return np.append(pose[:2], math.remainder(pose[2], 2 * math.pi))


def _drive_slips():
    yield "EULER_ODOMETRY", _arc(at=0.0, chord=False)
    yield "EULER_TURNS_FIRST", _arc(at=1.0, chord=False)
    yield "MIDPOINT_ODOMETRY", _arc(chord=False)
    for without_pi in (lambda turn: np.sinc(turn / 2), np.sinc):
        yield "SINC_WITHOUT_PI", _arc(sinc=without_pi)
    total = (_LEFT + _RIGHT) / _TRACK * _STEP
    for at, chord in _WAYS:
        way = {"at": at, "chord": chord}
        yield "TRACK_HALVED", _arc(track=_TRACK / 2, **way)
        yield "TRACK_DOUBLED", _arc(track=_TRACK * 2, **way)
        yield "SPEEDS_ADDED", _arc(reach=2.0, **way)
        yield "SPEED_SUM_TURNS", _arc(turn=lambda _turn: total, **way)
        yield "LEFT_RIGHT_SWAPPED", _arc(_RIGHT, _LEFT, **way)
        yield "DRIVE_SIN_COS_SWAPPED", _arc(swapped=True, **way)
        for convert in (math.degrees, math.radians):
            yield "TURN_IN_DEGREES", _arc(turn=convert, **way)
            yield "TURN_IN_DEGREES", _arc(angle=convert, **way)


def _of_slow_turns(submission):
    """Errors of slow turns by rate; each rate is tried at a few headings, because rounding is luck."""
    headings, dt = np.array([0.3, 1.0, 1.9, 2.6]), 2.0

    def of(rate):
        """Where it gets to, and where the arc does, (4, 2) each."""
        calls = [((0.0, 0.0, float(h)), 0.5 - rate / 4, 0.5 + rate / 4, 0.5, dt) for h in headings]
        ends = [kit.as_vector(end, 3, "pose")[:2] for end in submission.call_each("diff_drive_step", calls)]
        return np.array(ends), _along(headings + rate * dt / 2, 0.5 * dt * np.sinc(rate * dt / (2 * np.pi)))

    def worst(rate):
        return float(np.max(np.abs(np.subtract(*of(rate)))))

    def straight(rate):
        """Whether the way is one of a straight line, along the heading before, amid or after the turn."""
        ends, _ = of(rate)
        lines = [_along(headings + at * rate * dt, 0.5 * dt) for at in (0.0, 0.5, 1.0)]
        return any(np.allclose(ends, line, rtol=0, atol=1e-12) for line in lines)

    ahead = worst(0.0)
    if not math.isfinite(ahead):
        return named("STRAIGHT_DIVIDES_BY_ZERO")
    if ahead > 1e-6:
        return named("STRAIGHT_WRONG")
    slow = [rate for rate in (1e-4, 1e-3, 1e-2, 0.1) if worst(rate) > 1e-6]
    if slow:
        return named("SLOW_TURN_AS_STRAIGHT") if all(map(straight, slow)) else None
    return named("SMALL_TURN_CANCELS") if max(worst(1e-13), worst(1e-12)) > 1e-6 else None


def _along(headings, way):
    return way * np.stack((np.cos(headings), np.sin(headings)), axis=1)
