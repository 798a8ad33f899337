"""Actuators, odometry and the twin of ``digital-twin``, right and wrong; as ``formulas.py`` for sensors."""

from __future__ import annotations

import math

import numpy as np

# -- motor ----------------------------------------------------------------------------------------------


def _clip(u, limit):
    return min(max(u, -limit), limit)


def _dead(u, dead):
    return 0.0 if abs(u) <= dead else u


def _motor(
    keep=_dead,
    clip=_clip,
    share=lambda dt, tau: 1 - math.exp(-dt / tau),
    speed=lambda w, u_max: w,
    gives=lambda w, u, share: w + share * (u - w),
    ends=lambda w, u_max: w,
    holds=None,
):
    """``speed``: what counts as the speed before; ``holds``: what becomes of it inside the dead band."""

    def motor_step(w, u, dt, tau, u_max, deadband):
        if holds is not None and abs(u) <= deadband:
            return holds(w)
        u = clip(keep(u, deadband), u_max)
        return ends(gives(speed(w, u_max), u, share(dt, tau)), u_max)

    return motor_step


_MOTOR = {
    "keep": (
        ("DEADBAND_MISSING", lambda u, dead: u),
        ("BACKWARDS_SWALLOWED", lambda u, dead: 0.0 if u <= dead else u),
        ("DEADBAND_ONE_SIDED", lambda u, dead: 0.0 if 0 <= u <= dead else u),
        ("DEADBAND_SUBTRACTED", lambda u, dead: math.copysign(max(abs(u) - dead, 0.0), u)),
        ("DEADBAND_EDGE", lambda u, dead: 0.0 if abs(u) < dead else u),
        ("DEADBAND_WIDTH", lambda u, dead: 0.0 if abs(u) <= dead / 2 else u),
        ("DEADBAND_REVERSED", lambda u, dead: u if abs(u) <= dead else 0.0),
    ),
    "clip": (
        ("SATURATION_MISSING", lambda u, limit: u),
        ("SATURATION_ONE_SIDED", min),
        ("SATURATION_ONE_SIDED", lambda u, limit: max(u, -limit)),
        ("BACKWARDS_SWALLOWED", lambda u, limit: min(max(u, 0.0), limit)),
        ("SATURATION_AS_SWITCH", lambda u, limit: 0.0 if abs(u) > limit else u),
    ),
    "share": (
        ("LAG_EULER_UNSTABLE", lambda dt, tau: dt / tau),
        ("LAG_EULER_UNSTABLE", lambda dt, tau: min(dt / tau, 1.0)),
        ("LAG_IMPLICIT", lambda dt, tau: dt / (tau + dt)),
        ("LAG_INVERTED", lambda dt, tau: math.exp(-dt / tau)),
        ("LAG_MISSING", lambda dt, tau: 1.0),
        ("LAG_RATIO_INVERTED", lambda dt, tau: 1 - math.exp(-tau / dt)),
        ("LAG_OF_PRODUCT", lambda dt, tau: 1 - math.exp(-dt * tau)),
        ("LAG_SIGN", lambda dt, tau: 1 - math.exp(dt / tau)),
        ("LAG_BASE", lambda dt, tau: 1 - 2 ** (-dt / tau)),
        ("LAG_BASE", lambda dt, tau: 1 - 10 ** (-dt / tau)),
        ("LAG_WITHOUT_DT", lambda dt, tau: 1 - math.exp(-1 / tau)),
        ("LAG_OFF_BY_FACTOR", lambda dt, tau: 1 - math.exp(-dt / (2 * tau))),
        ("LAG_OFF_BY_FACTOR", lambda dt, tau: 1 - math.exp(-2 * dt / tau)),
    ),
    "speed": (
        ("SPEED_IGNORED", lambda w, u_max: 0.0),
        ("CLIPS_SPEED_NOT_COMMAND", _clip),
    ),
    "gives": (
        ("SPEED_GROWS", lambda w, u, share: w + share * u),
        ("LAG_SIGN", lambda w, u, share: w - share * (u - w)),
        ("RETURNS_CHANGE", lambda w, u, share: share * (u - w)),
    ),
    "ends": (("CLIPS_SPEED_NOT_COMMAND", _clip),),
    "holds": (
        ("DEADBAND_STOPS_MOTOR", lambda w: 0.0),
        ("DEADBAND_STOPS_MOTOR", lambda w: w),
    ),
}


def _clipped_only_at_the_end(w, u, dt, tau, u_max, deadband):
    u = 0.0 if abs(u) <= deadband else u
    return _clip(w - math.expm1(-dt / tau) * (u - w), u_max)


def _dead_about_the_speed(clipped):
    def motor_step(w, u, dt, tau, u_max, deadband):
        goal = _clip(u, u_max)
        return w if abs((goal if clipped else u) - w) <= deadband else w - math.expm1(-dt / tau) * (goal - w)

    return motor_step


def _difference_clipped(w, u, dt, tau, u_max, deadband):
    return w - math.expm1(-dt / tau) * _clip(_dead(u, deadband) - w, u_max)


def _stopped_within(w, u, dt, tau, u_max, deadband):
    w = w - math.expm1(-dt / tau) * (_clip(u, u_max) - w)
    return w if abs(w) > deadband else 0.0


# -- backlash -------------------------------------------------------------------------------------------


def _play(
    half=lambda gap: gap / 2, rule=lambda x, s, h: min(max(s, x - h), x + h), gives=lambda y, x, s: (y, y)
):
    def backlash(x, gap, state):
        y = rule(x, state, half(gap))
        return gives(y, x, state)

    return backlash


_PLAY = {
    "half": (
        ("GAP_DOUBLED", lambda gap: gap),
        ("GAP_HALVED", lambda gap: gap / 4),
        ("BACKLASH_MISSING", lambda gap: 0.0),
    ),
    "rule": (
        ("BACKLASH_IS_DEAD_BAND", lambda x, s, h: x - _clip(x, h)),
        ("BACKLASH_IS_DEAD_BAND", lambda x, s, h: 0.0 if abs(x) <= h else x),
        ("BACKLASH_SNAPS", lambda x, s, h: s if abs(x - s) <= h else x),
        ("BACKLASH_WRONG_EDGE", lambda x, s, h: s if abs(x - s) <= h else x + math.copysign(h, x - s)),
        ("BACKLASH_SIDE_OF_ZERO", lambda x, s, h: s if abs(x - s) <= h else x - math.copysign(h, x)),
        ("BACKLASH_ONE_SIDED", lambda x, s, h: max(s, x - h)),
        ("BACKLASH_ONE_SIDED", lambda x, s, h: min(s, x + h)),
        ("BACKLASH_SAME_SIDE", lambda x, s, h: max(min(s, x - h), x + h)),
        ("BACKLASH_SAME_SIDE", lambda x, s, h: min(max(s, x + h), x - h)),
        ("BACKLASH_CLIPS_INPUT", lambda x, s, h: min(max(x, s - h), s + h)),
        ("BACKLASH_HOLDS", lambda x, s, h: s),
        ("BACKLASH_ADDS_INPUT", lambda x, s, h: s if abs(x - s) <= h else s + x - math.copysign(h, x - s)),
    ),
    "gives": (
        ("STATE_IS_NOT_OUTPUT", lambda y, x, s: (y, x)),
        ("STATE_IS_NOT_OUTPUT", lambda y, x, s: (y, s)),
        ("STATE_IS_NOT_OUTPUT", lambda y, x, s: (y, x - y)),
        ("OUTPUT_IS_NOT_STATE", lambda y, x, s: (x, y)),
    ),
}


def _behind(of, kept):
    """Half a gap behind x, whichever way it went from ``of``; what is kept is the output or x."""

    def backlash(x, gap, state):
        y = x - math.copysign(gap / 2, x - state) if x != state else of(x, state)
        return y, kept(y, x)

    return backlash


# -- delay ----------------------------------------------------------------------------------------------


def _delay(
    place=lambda k, dt, latency: k - latency / dt, before=lambda x: 0.0, weigh=lambda part: part, shift=0
):
    """``place``: of a moment among the samples; ``before``: of the first; ``weigh``: of the later sample."""

    def delay_line(x, dt, latency):
        y = np.zeros(len(x))
        for k in range(len(x)):
            at = place(k, dt, latency)
            i = math.floor(at + 1e-9)
            part = max(at - i, 0.0)
            if at < -1e-9:
                y[k] = before(x) if not isinstance(before(x), str) else _wrapped(x, i, part, before(x))
            elif i + 1 < len(x):
                w = weigh(part)
                y[k] = (1 - w) * x[i] + w * x[i + 1]
            else:
                y[k] = x[-1]
        return y

    return delay_line


def _wrapped(x, i, part, way):
    if way == "ramp":
        return part * x[0] if i == -1 else 0.0
    return (1 - part) * x[i % len(x)] + part * x[(i + 1) % len(x)]


_DELAY = {
    "place": (
        ("DELAY_ADVANCES", lambda k, dt, latency: k + latency / dt),
        ("DELAY_IN_SAMPLES", lambda k, dt, latency: k - latency),
        ("DELAY_OF_PRODUCT", lambda k, dt, latency: k - latency * dt),
        ("DELAY_IGNORED", lambda k, dt, latency: k),
        ("DELAY_ONE_TOO_LONG", lambda k, dt, latency: k - latency / dt - 1),
        ("DELAY_ONE_TOO_SHORT", lambda k, dt, latency: k - latency / dt + 1),
    ),
    "before": (
        ("DELAY_HOLDS_FIRST", lambda x: x[0]),
        ("DELAY_RAMPS_IN", lambda x: "ramp"),
        ("DELAY_WRAPS", lambda x: "around"),
        ("DELAY_NAN_BEFORE", lambda x: math.nan),
    ),
    "weigh": (
        ("DELAY_WHOLE_SAMPLES", lambda part: 0.0),
        ("DELAY_WHOLE_SAMPLES", lambda part: 1.0 if part > 1e-9 else 0.0),
        ("DELAY_WHOLE_SAMPLES", lambda part: float(part >= 0.5)),
        ("DELAY_SHARES_SWAPPED", lambda part: 1 - part),
        ("DELAY_HALF_WAY", lambda part: 0.5 if part > 1e-9 else 0.0),
    ),
}


def _shifted(count):
    """Whole samples, as slices: what is left of the latency is dropped or rounded up."""

    def delay_line(x, dt, latency):
        whole = count(latency / dt)
        return np.concatenate((np.zeros(whole), np.asarray(x, dtype=float)))[: len(x)]

    return delay_line


def _held(count):
    def delay_line(x, dt, latency):
        return np.concatenate((np.full(count(latency / dt), x[0]), np.asarray(x, dtype=float)))[: len(x)]

    return delay_line


def _beyond_the_nearest(first):
    """The latency rounded to the nearest sample, and the rest as a share, even where it is negative.

    first: what of the first sample is there when it comes, from the rest
    """

    def delay_line(x, dt, latency):
        whole = round(latency / dt)
        rest = latency / dt - whole
        y = np.zeros(len(x))
        for k in range(whole, len(x)):
            y[k] = (1 - rest) * x[k - whole] + rest * x[k - whole - 1] if k > whole else first(rest) * x[0]
        return y

    return delay_line


def _rolled(count):
    return lambda x, dt, latency: np.roll(x, count(latency / dt))


def _at_end(x, dt, latency):
    t = dt * np.arange(len(x))
    return np.interp(t + latency, t, x, right=0.0)


def _circle(x, dt, latency):
    t = dt * np.arange(len(x))
    return np.interp(t - latency, t, x, period=dt * len(x))


def _lagging(share, first):
    """``share(dt, latency)`` of the way to each sample, from 0 or from the ``first`` sample."""

    def delay_line(x, dt, latency):
        part = share(dt, latency) if latency > 0 else 1.0
        y, value = np.zeros(len(x)), first * x[0]
        for k in range(len(x)):
            value += part * (x[k] - value)
            y[k] = value
        return y

    return delay_line


_SHARES = (
    lambda dt, latency: 1 - math.exp(-dt / latency),
    lambda dt, latency: min(dt / latency, 1.0),
    lambda dt, latency: dt / (latency + dt),
)
_COUNTS = (lambda s: int(s + 1e-9), round, lambda s: math.ceil(s - 1e-9))

# -- differential drive ---------------------------------------------------------------------------------


def _arc(
    speed=lambda left, right: (left + right) / 2,
    rate=lambda left, right, track: (right - left) / track,
    turns=lambda rate, dt: rate * dt,
    chord=lambda turn: np.sinc(turn / (2 * np.pi)),
    way=lambda v, dt: v * dt,
    middle=lambda heading, turn: heading + turn / 2,
    vector=lambda angle: (math.cos(angle), math.sin(angle)),
    ends=lambda heading, turn: heading + turn,
    starts=lambda pose: pose,
):
    def diff_drive_step(pose, v_left, v_right, track, dt):
        x, y, heading = starts(np.asarray(pose, dtype=float))
        turn = turns(rate(v_left, v_right, track), dt)
        length = way(speed(v_left, v_right), dt) * chord(turn)
        c, s = vector(middle(heading, turn))
        return np.array([x + length * c, y + length * s, ends(heading, turn)])

    return diff_drive_step


def _whole_turn_below(limit):
    """The chord's factor by its series in turns below a limit, with the whole turn for its half."""
    return lambda turn: 1 - turn**2 / 6 if abs(turn) < limit else np.sinc(turn / (2 * np.pi))


def _straight_on_one_side(sign):
    """Turns to one side by their chord, and those to the other as if the robot rolled straight."""

    def diff_drive_step(pose, v_left, v_right, track, dt):
        turns = sign * (v_right - v_left) > 0
        return _arc(**({} if turns else _EULER))(pose, v_left, v_right, track, dt)

    return diff_drive_step


_DRIVE = {
    "speed": (
        ("SPEEDS_ADDED", lambda left, right: left + right),
        ("SPEED_IS_DIFFERENCE", lambda left, right: (right - left) / 2),
        ("SPEED_OF_ONE_WHEEL", lambda left, right: right),
        ("SPEED_OF_ONE_WHEEL", lambda left, right: left),
    ),
    "rate": (
        ("LEFT_RIGHT_SWAPPED", lambda left, right, track: (left - right) / track),
        ("TRACK_HALVED", lambda left, right, track: 2 * (right - left) / track),
        ("TRACK_DOUBLED", lambda left, right, track: (right - left) / (2 * track)),
        ("SPEED_SUM_TURNS", lambda left, right, track: (right + left) / track),
        ("TRACK_MULTIPLIED", lambda left, right, track: (right - left) * track),
        ("TRACK_IGNORED", lambda left, right, track: right - left),
        ("TURN_IN_DEGREES", lambda left, right, track: math.degrees((right - left) / track)),
        ("TURN_IN_DEGREES", lambda left, right, track: math.radians((right - left) / track)),
    ),
    "turns": (("TURN_WITHOUT_DT", lambda rate, dt: rate),),
    "chord": (
        ("MIDPOINT_ODOMETRY", lambda turn: 1.0),
        ("SINC_WITHOUT_PI", np.sinc),
        ("SINC_WITHOUT_PI", lambda turn: np.sinc(turn / 2)),
        ("CHORD_OF_WHOLE_TURN", lambda turn: math.sin(turn) / turn if turn else 1.0),
        ("CHORD_ON_ONE_SIDE", lambda turn: np.sinc(turn / (2 * np.pi)) if turn > 0 else 1.0),
        ("CHORD_ON_ONE_SIDE", lambda turn: np.sinc(turn / (2 * np.pi)) if turn < 0 else 1.0),
        ("SERIES_OF_WHOLE_TURN", _whole_turn_below(0.1)),
        ("SERIES_OF_WHOLE_TURN", _whole_turn_below(0.02)),
        ("SERIES_OF_WHOLE_TURN", _whole_turn_below(math.inf)),
        ("CHORD_INVERTED", lambda turn: 1 / np.sinc(turn / (2 * np.pi))),
        ("STRAIGHT_DIVIDES_BY_ZERO", lambda turn: math.sin(turn / 2) / (turn / 2) if turn else math.nan),
    ),
    "way": (("WAY_WITHOUT_DT", lambda v, dt: v),),
    "middle": (
        ("CHORD_ALONG_OLD_HEADING", lambda heading, turn: heading),
        ("CHORD_ALONG_NEW_HEADING", lambda heading, turn: heading + turn),
        ("CHORD_TURNED_BACK", lambda heading, turn: heading - turn / 2),
    ),
    "vector": (
        ("DRIVE_SIN_COS_SWAPPED", lambda angle: (math.sin(angle), math.cos(angle))),
        ("TURN_IN_DEGREES", lambda angle: (math.cos(math.degrees(angle)), math.sin(math.degrees(angle)))),
        ("TURN_IN_DEGREES", lambda angle: (math.cos(math.radians(angle)), math.sin(math.radians(angle)))),
        ("Y_MIRRORED", lambda angle: (math.cos(angle), -math.sin(angle))),
    ),
    "ends": (
        ("HEADING_NOT_TURNED", lambda heading, turn: heading),
        ("HEADING_HALF_TURNED", lambda heading, turn: heading + turn / 2),
        ("HEADING_FORGOTTEN", lambda heading, turn: turn),
        ("HEADING_WRAPPED", lambda heading, turn: math.remainder(heading + turn, 2 * math.pi)),
        ("HEADING_WRAPPED", lambda heading, turn: (heading + turn) % (2 * math.pi)),
    ),
    "starts": (
        ("POSE_FORGOTTEN", lambda pose: (0.0, 0.0, pose[2])),
        ("POSE_FORGOTTEN", lambda pose: (0.0, 0.0, 0.0)),
    ),
}
#: Rolling straight, along the old heading or the new: both at once are one mistake.
_EULER = {"chord": lambda turn: 1.0, "middle": lambda heading, turn: heading}
_TURNED_FIRST = {"chord": lambda turn: 1.0, "middle": lambda heading, turn: heading + turn}
_STRAIGHT = {term: forms for term, forms in _DRIVE.items() if term not in {"chord", "middle"}}

# -- the twin -------------------------------------------------------------------------------------------


def _sync(
    span=lambda twin, t: t - twin["t"],
    late="left out",
    accel=lambda drive, friction, v: drive - friction * v,
    surprise=lambda z, x: z - x,
    shares=(0.3, 0.3, -0.15),
    sign=lambda v: math.copysign(1.0, v),
    clock=lambda twin, t: max(twin["t"], t),
    drive=lambda u: u,
):
    """Constant shares, as in the README; ``late``: what becomes of a measurement that is not new."""

    def sync(twin, z, t_measured):
        dt = span(twin, t_measured)
        if t_measured < twin["t"] and late == "left out":
            return dict(twin)
        x, v, b = twin["position"], twin["speed"], twin["friction"]
        n = max(1, math.ceil(abs(dt) / 0.002))
        for _ in range(n):
            a = accel(twin["drive"], b, v)
            x, v = x + dt / n * v + (dt / n) ** 2 / 2 * a, v + dt / n * a
        s = surprise(z, x)
        x, v, b = x + shares[0] * s, v + shares[1] * s, b + shares[2] * s * sign(v)
        state = {"position": x, "speed": v, "friction": b, "drive": drive(twin["drive"])}
        return {**twin, "t": clock(twin, t_measured), **state}

    return sync


_SYNC = {
    "span": (
        ("STEP_FIXED", lambda twin, t: 0.1),
        ("NO_PREDICTION", lambda twin, t: 0.0),
    ),
    "accel": (
        ("DRIVE_NOT_USED", lambda u, b, v: -b * v),
        ("FRICTION_SPEEDS_UP", lambda u, b, v: u + b * v),
        ("FRICTION_NOT_IN_MODEL", lambda u, b, v: u),
        ("FRICTION_NOT_IN_MODEL", lambda u, b, v: 0.0),
        ("FRICTION_WITHOUT_SPEED", lambda u, b, v: u - b),
    ),
    "surprise": (("SURPRISE_INVERTED", lambda z, x: x - z),),
    "shares": (
        ("NO_CORRECTION", (0.0, 0.3, -0.15)),
        ("FRICTION_NOT_LEARNED", (0.3, 0.3, 0.0)),
        ("FRICTION_LEARNS_BACKWARDS", (0.3, 0.3, 0.15)),
        ("BELIEVES_MEASUREMENT", (1.0, 0.3, -0.15)),
        ("SURPRISE_INVERTED", (-0.3, 0.3, -0.15)),
    ),
    "sign": (("LEARNS_FORWARDS_ONLY", lambda v: 1.0),),
    "clock": (("TIME_NOT_ADVANCED", lambda twin, t: twin["t"]),),
    "drive": (("DRIVE_CHANGED", lambda u: 0.0),),
}
_LATE = {
    "span": (("LATE_USED_AS_CURRENT", lambda twin, t: max(t - twin["t"], 0.0)),),
    "clock": (("TIME_RUNS_BACK", lambda twin, t: t),),
}


def _command(
    friction=lambda twin: twin["friction"],
    speed=lambda twin, target: target,
    law=lambda b, v: b * v,
    gain=0.0,
    adds=lambda twin: 0.0,
):
    def command(twin, target_speed):
        pushed = gain * (target_speed - twin["speed"])
        return law(friction(twin), speed(twin, target_speed)) + pushed + adds(twin)

    return command


_COMMAND = {
    "friction": (
        ("FRICTION_IGNORED", lambda twin: 1.0),
        ("FRICTION_IGNORED", lambda twin: 0.5),
        ("FRICTION_ADDED", lambda twin: twin["friction"] + 1.0),
    ),
    "speed": (
        ("USES_TWIN_SPEED", lambda twin, target: twin["speed"]),
        ("TARGET_IGNORED", lambda twin, target: 1.0),
        ("BACKWARDS_NOT_DRIVEN", lambda twin, target: abs(target)),
        ("BACKWARDS_NOT_DRIVEN", lambda twin, target: max(target, 0.0)),
        ("FRICTION_ON_SURPLUS", lambda twin, target: target - twin["speed"]),
        ("FRICTION_ON_SURPLUS", lambda twin, target: target + twin["speed"]),
    ),
    "law": (
        ("DIVIDES_BY_FRICTION", lambda b, v: v / b),
        ("BRAKES", lambda b, v: -b * v),
        ("TARGET_SQUARED", lambda b, v: b * v * abs(v)),
        ("TARGET_SQUARED", lambda b, v: b * v**2),
        ("FRICTION_SQUARED", lambda b, v: b**2 * v),
        ("FRICTION_WITHOUT_TARGET", lambda b, v: b),
        ("FRICTION_WITHOUT_TARGET", lambda b, v: math.copysign(b, v)),
        ("DRIVE_OFF_BY_FACTOR", lambda b, v: b * v / 2),
        ("DRIVE_OFF_BY_FACTOR", lambda b, v: 2 * b * v),
        ("BALANCE_MISSING", lambda b, v: 0.0),
    ),
    "gain": (
        ("PUSHES_AWAY", -0.5),
        ("PUSHES_AWAY", -1.0),
        ("PUSHES_AWAY", -2.0),
    ),
    "adds": (
        ("ADDS_CURRENT_DRIVE", lambda twin: twin["drive"]),
        ("ADDS_CURRENT_DRIVE", lambda twin: -twin["drive"]),
    ),
}

#: With a large enough correction, the friction on the twin's own speed ends at the target all the same.
_WRONG_WAY = {term: forms for term, forms in _COMMAND.items() if term != "gain"}
_CORRECTED = _COMMAND | {"speed": tuple(form for form in _COMMAND["speed"] if form[0] != "USES_TWIN_SPEED")}

TERMS = {
    "motor_step": [(_motor, {}, _MOTOR)],
    "backlash": [(_play, {}, _PLAY)],
    "delay_line": [(_delay, {}, _DELAY)],
    "diff_drive_step": [(_arc, {}, _DRIVE), *((_arc, base, _STRAIGHT) for base in (_EULER, _TURNED_FIRST))],
    "sync": [(_sync, {}, _SYNC), (_sync, {"late": "used"}, _LATE)],
    "command": [
        (_command, {}, _COMMAND),
        *((_command, {"gain": gain}, _CORRECTED) for gain in (0.5, 1.0, 2.0)),
        *((_command, {"gain": gain}, _WRONG_WAY) for gain in (-0.5, -1.0, -2.0)),
    ],
}
#: Programs that are wrong in another way, with their codes.
OTHERS = {
    "motor_step": [
        (("CLIPS_SPEED_NOT_COMMAND",), _clipped_only_at_the_end),
        (("DEADBAND_OF_DIFFERENCE",), _dead_about_the_speed(clipped=True)),
        (("DEADBAND_OF_DIFFERENCE",), _dead_about_the_speed(clipped=False)),
        (("DEADBAND_OF_SPEED",), _stopped_within),
        (("SATURATION_OF_DIFFERENCE",), _difference_clipped),
    ],
    "backlash": [
        (("BACKLASH_NEVER_RESTS",), _behind(of=lambda x, state: x, kept=lambda y, x: x)),
        (("BACKLASH_NEVER_RESTS",), _behind(of=lambda x, state: state, kept=lambda y, x: y)),
    ],
    "delay_line": [
        *((("DELAY_WHOLE_SAMPLES",), _shifted(count)) for count in _COUNTS),
        *((("DELAY_WHOLE_SAMPLES", "DELAY_HOLDS_FIRST"), _held(count)) for count in _COUNTS),
        *((("DELAY_WRAPS",), _rolled(count)) for count in _COUNTS),
        (("DELAY_ADVANCES",), _at_end),
        (("DELAY_SHARE_NEGATIVE",), _beyond_the_nearest(lambda rest: float(rest <= 0))),
        (("DELAY_SHARE_NEGATIVE",), _beyond_the_nearest(lambda rest: float(rest == 0))),
        (("DELAY_SHARE_NEGATIVE",), _beyond_the_nearest(lambda rest: 1 - rest)),
        (("DELAY_COVERS_START",), lambda x, dt, latency: np.where(dt * np.arange(len(x)) >= latency, x, 0.0)),
        (("DELAY_WRAPS",), _circle),
        *((("DELAY_AS_LAG",), _lagging(share, first)) for share in _SHARES for first in (0.0, 1.0)),
    ],
    "diff_drive_step": [
        (("EULER_ODOMETRY",), _arc(**_EULER)),
        (("EULER_TURNS_FIRST",), _arc(**_TURNED_FIRST)),
        *((("CHORD_ON_ONE_SIDE",), _straight_on_one_side(sign)) for sign in (1.0, -1.0)),
    ],
}
