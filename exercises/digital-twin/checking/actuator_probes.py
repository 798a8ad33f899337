"""Finding out which mistake an actuator or the odometry of ``digital-twin`` makes, by what it has in common
with others. Which known program it is, ``hypotheses.json`` tells; a probe speaks where none of them fits.
"""

from __future__ import annotations

import math

import numpy as np

from course.scoring import kit

named = kit.words("digital-twin")


# -- motor ----------------------------------------------------------------------------------------------

#: w, u, neither swallowed nor too large, for a dead band of 2 and u_max of 10; and what share dt and tau give
_WAYS = ((1.0, 6.0), (1.0, -6.0), (-3.0, 8.0))
_DT, _TAU, _SHARE = 0.3, 0.5, 0.45118836


@np.errstate(all="ignore")  # a submission may have returned anything
def of_motor(submission):
    """The mistake that ``motor_step`` makes on commands that neither dead band nor limit touches."""
    calls = [(w, u, _DT, _TAU, 10.0, 2.0) for w, u in _WAYS]
    calls += [(1.0, u, dt, _TAU, 10.0, 2.0) for u in (6.0, -6.0) for dt in (0.01, 1.0)]
    values = [kit.as_number(value, "w_next") for value in submission.call_each("motor_step", calls)]
    if not all(map(math.isfinite, values)):
        return None
    lagged = [w + (u - w) * -math.expm1(-dt / tau) for w, u, dt, tau, *_ in calls]
    if np.allclose(values, [w * (abs(w) > 2.0) for w in lagged], rtol=0, atol=1e-9):
        return named("DEADBAND_OF_SPEED")
    up, far_up, down, far_down = values[-4:]
    if up == far_up != 1.0 and down == far_down != 1.0 and up != down:
        return named("LAG_WITHOUT_DT")
    shares = [(value - w) / (u - w) for value, (w, u) in zip(values, _WAYS, strict=False)]
    if max(shares) - min(shares) > 1e-9:
        return None
    if abs(shares[0] - _SHARE) > 1e-6:
        return named("LAG_SHARE_WRONG") if 0.0 < shares[0] < 1.0 else None
    return named("DEADBAND_WIDTH") if _other_width(submission) else None


def of_speed_limit(submission):
    """Whether a motor that is faster than u_max is at u_max at once."""
    value = kit.as_number(submission.call("motor_step", 30.0, 5.0, _DT, _TAU, 10.0, 2.0), "w_next")
    clipped = 10.0, 10.0 + _SHARE * (5.0 - 10.0)  # after the lag, or before
    return named("CLIPS_SPEED_NOT_COMMAND") if min(abs(np.subtract(clipped, value))) < 1e-6 else None


def _other_width(submission):
    """Whether, for either sign, the dead band ends elsewhere than at its limit."""
    commands = (0.2, -0.2, 1.7, -1.7, 2.3, -2.3, 8.0, -8.0)
    calls = [(0.0, u, _DT, _TAU, 10.0, 2.0) for u in commands]
    goals = np.array([kit.as_number(w, "w_next") for w in submission.call_each("motor_step", calls)]) / _SHARE
    moved = np.abs(goals - commands) < 1e-6
    still = np.abs(goals) < 1e-9
    ends = all(still[:2]) and all(moved[6:]) and np.all(moved | still)
    return bool(ends and (np.all(moved[2:4]) or np.all(still[4:6])))


# -- backlash -------------------------------------------------------------------------------------------

#: x, state, and the output for a gap of 1: inside the play, beyond either side, far off, at the edge
_PLAY = (
    (0.3, 0.1, 0.1),
    (0.9, 0.0, 0.4),
    (-0.9, 0.0, -0.4),
    (0.2, 1.4, 0.7),
    (5.0, 1.0, 4.5),
    (1.5, 1.0, 1.0),
)


@np.errstate(all="ignore")  # a submission may have returned anything
def of_backlash(submission):
    """The mistake that ``backlash`` makes in single calls from known states."""
    if _remembers(submission):
        return named("STATE_IN_MODULE")
    values = submission.call_each("backlash", [(x, 1.0, state) for x, state, _ in _PLAY])
    pairs = [kit.as_tuple(value, ("y", "state_next")) for value in values]
    outputs = [kit.as_number(y, "y") for y, _ in pairs]
    right, states = [y for *_, y in _PLAY], [kit.as_number(state, "state_next") for _, state in pairs]
    if np.allclose(outputs, right, rtol=0, atol=1e-12):
        return None if np.allclose(states, outputs, rtol=0, atol=1e-12) else named("STATE_IS_NOT_OUTPUT")
    if np.allclose(states, right, rtol=0, atol=1e-12) and outputs == [state for _, state, _ in _PLAY]:
        return named("OUTPUT_A_CALL_LATE")
    if ends := _of_ends(submission):
        return named(ends)
    return named("BACKLASH_RATE_DEPENDENT") if _counts_steps(submission) else None


def _counts_steps(submission):
    """Whether the same way in two steps ends elsewhere than in one."""

    def read(x, state):
        y, state = kit.as_tuple(submission.call("backlash", x, 1.0, state), ("y", "state_next"))
        return kit.as_number(y, "y"), kit.as_number(state, "state_next")

    ways = ((0.0, 2.0, 5.0), (0.0, -2.0, -5.0))
    ends = [(read(far, read(half, start)[1])[0], read(far, start)[0]) for start, half, far in ways]
    return all(abs(in_two - in_one) > 1e-9 for in_two, in_one in ends)


def _of_ends(submission):
    """What is wrong with the slot of a pin that, pushed far up or down, stays as far behind each time."""
    ways = ((5.0, 1.0), (7.0, -3.0), (-5.0, -1.0), (-6.0, 2.0))
    values = submission.call_each("backlash", [(x, 1.0, state) for x, state in ways])
    ends = [kit.as_number(kit.as_tuple(value, ("y", "state_next"))[0], "y") for value in values]
    up, far_up, down, far_down = (y - x for y, (x, _) in zip(ends, ways, strict=True))
    if not max(abs(up - far_up), abs(down - far_down)) < 1e-9:
        return None
    if abs(up + down) > 1e-9:
        return "SLOT_OFF_CENTRE"
    return "GAP_SCALED" if up < -1e-9 and abs(up + 0.5) > 1e-9 else None


def _remembers(submission):
    """Whether one and the same call gives something else after another call."""
    far = (-9.0, 1.0, -9.0), (9.0, 1.0, 9.0)
    values = submission.call_each("backlash", [far[0], (0.3, 1.0, 0.1), far[1], (0.3, 1.0, 0.1)])
    first, again = (kit.as_number(kit.as_tuple(values[i], ("y", "state_next"))[0], "y") for i in (1, 3))
    return first != again and not (math.isnan(first) and math.isnan(again))


# -- delay ----------------------------------------------------------------------------------------------


@np.errstate(all="ignore")  # a submission may have returned anything
def of_delay(submission):
    """What ``delay_line`` does to signals whose form does not depend on how fine they are sampled."""
    x, dt = np.array([3.0, 1.0, 4.0, 1.5, 9.0, 2.0, 6.0, 5.0]), 0.1
    lates = (0.02, 0.08, 0.26)
    values = submission.call_each("delay_line", [*((x, dt, late) for late in lates), (x**0, dt, lates[-1])])
    *rows, step = (kit.as_vector(value, len(x), "the delayed signal") for value in values)
    if not np.all(np.isfinite(rows)):
        return None
    shifts = [_shift(row, x) for row in rows]
    near = None not in shifts and np.all(np.abs(np.subtract(shifts, np.array(lates) / dt)) <= 1.0)
    t = dt * np.arange(len(x))
    circles = [np.interp(t - late, t, x, period=dt * len(x)) for late in lates]
    first = [row[: round(late / dt + 0.4999)] for row, late in zip(rows, lates, strict=True)]
    held = all(np.all(part == x[0]) for part in first) and not np.all(rows[0] == x[0])
    creeps = np.all(np.diff(step[1:]) > 1e-9) and np.all(np.diff(step[1:], 2) < -1e-9) and step[-1] < 1 - 1e-9
    looks = (
        ("DELAY_AS_LAG", creeps),
        ("DELAY_WHOLE_SAMPLES", near and shifts[2] > shifts[0]),
        ("DELAY_WRAPS", np.allclose(rows, circles, rtol=0, atol=1e-9)),
        ("DELAY_SHARES_SWAPPED", _swaps(submission, dt)),
        ("DELAY_HOLDS_FIRST", held),
    )
    code = next((code for code, seen in looks if seen), None) or _of_halves(submission, x, dt)
    return named(code) if code else None


def _swaps(submission, dt):
    """Whether the shares of two samples are exchanged, at three tenths of the way and at eight."""
    pulse, parts = np.eye(8)[3], (0.3, 0.8)
    values = submission.call_each("delay_line", [(pulse, dt, part * dt) for part in parts])
    seen = [kit.as_vector(value, len(pulse), "the delayed signal")[3:5] for value in values]
    return all(np.allclose(pair, (part, 1 - part)) for pair, part in zip(seen, parts, strict=True))


def _of_halves(submission, x, dt):
    """Where all is right after two samples, what is wrong after two and a half."""
    values = submission.call_each("delay_line", [(x, dt, samples * dt) for samples in (2.0, 2.5)])
    whole, half = (kit.as_vector(value, len(x), "the delayed signal") for value in values)
    if not np.allclose(whole, [0.0, 0.0, *x[:-2]], rtol=0, atol=1e-9):
        return None
    before, after = x[:-3], x[1:-2]
    shares = (half[3:] - after) / (before - after)
    if np.ptp(shares) < 1e-9:
        return "DELAY_SHARE_WRONG" if 0.0 < shares[0] < 1.0 and abs(shares[0] - 0.5) > 1e-6 else None
    known = [np.abs(half[3:] - line) < 1e-6 for line in ((before + after) / 2, before, after)]
    return None if np.any(known) else "DELAY_NOT_STRAIGHT"


def _shift(row, x):
    """By how many whole samples ``row`` is x, later; None if it is by none."""
    return next((n for n in range(len(x)) if np.array_equal(row[n:], x[: len(x) - n])), None)


# -- differential drive ---------------------------------------------------------------------------------

#: One turn of no pattern and where it ends.
_TURN = (1.0, 2.0, 2.5), 0.31, 0.83, 0.47, 1.3
_TURN_ENDS = 0.323280040909522, 1.9474106320399334, 3.9382978723404256


@np.errstate(all="ignore")  # a submission may have returned anything
def of_drive(submission, heading=False):
    """The mistake that ``diff_drive_step`` makes: where one turn is right, in ever slower ones.

    heading: whether it is the heading that is wrong, and not the position
    """
    end = kit.as_vector(submission.call("diff_drive_step", *_TURN), 3, "pose")
    if not np.all(np.isfinite(end)):
        return None
    way, right = np.subtract(end[:2], _TURN[0][:2]), np.subtract(_TURN_ENDS[:2], _TURN[0][:2])
    parts, turned = way / right, abs(end[2] - _TURN_ENDS[2]) < 1e-9
    length = abs(_way(end) - _way(_TURN_ENDS)) < 1e-9
    ended = np.allclose(end, _TURN_ENDS, rtol=1e-9, atol=1e-12)
    looks = (
        ("Y_MIRRORED", turned and np.allclose(parts, (1.0, -1.0), rtol=0, atol=1e-9)),
        ("CHORD_WRONG_WAY", turned and length and abs(end[1] - _TURN_ENDS[1]) > 1e-6),
        ("CHORD_WRONG_LENGTH", turned and np.ptp(parts) < 1e-9 and parts[0] > 0 and abs(parts[0] - 1) > 1e-6),
        ("RIGHT_TURNS_BACKWARDS", ended and _backwards(submission)),
    )
    code = next((code for code, seen in looks if seen), None)
    if code or not ended:
        return named(code) if code else None
    return kit.attempt(lambda: (_of_slow_headings if heading else _of_slow_turns)(submission))


def _backwards(submission):
    """Whether the same turn to the right ends behind where it began, as far as it should be ahead."""
    pose, v_left, v_right, *rest = _TURN
    end = kit.as_vector(submission.call("diff_drive_step", pose, v_right, v_left, *rest), 3, "pose")
    turn = pose[2] - _TURN_ENDS[2]
    chord = _along(np.array([pose[2] + turn / 2]), _way(_TURN_ENDS))[0]
    return np.allclose(end, [*(pose[:2] - chord), pose[2] + turn], rtol=0, atol=1e-9)


def _way(end):
    """How far the turn has led from where it began, m."""
    return math.hypot(end[0] - _TURN[0][0], end[1] - _TURN[0][1])


def _of_slow_headings(submission):
    """Whether some slow turns leave the heading as it was."""
    rates = 10.0 ** np.arange(-8, -1)
    calls = [((0.0, 0.0, 1.0), 0.5 - rate / 4, 0.5 + rate / 4, 0.5, 2.0) for rate in rates]
    ends = [kit.as_vector(end, 3, "pose")[2] for end in submission.call_each("diff_drive_step", calls)]
    return named("SLOW_TURN_NOT_TURNED") if np.any(np.abs(np.subtract(ends, 1.0)) < 1e-12) else None


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

    def ragged(rate):
        """Whether headings that hardly differ lead to places that do, as rounding makes them."""
        calls = [((0.0, 0.0, 1.0 + 1e-9 * i), 0.5 - rate / 4, 0.5 + rate / 4, 0.5, dt) for i in range(6)]
        ends = [kit.as_vector(end, 3, "pose")[:2] for end in submission.call_each("diff_drive_step", calls)]
        return bool(np.max(np.ptp(ends, axis=0)) > 1e-7)

    ahead = worst(0.0)
    if not math.isfinite(ahead):
        return named("STRAIGHT_DIVIDES_BY_ZERO")
    if ahead > 1e-6:
        return named("SMALL_TURN_CANCELS" if ragged(0.0) else "STRAIGHT_WRONG")
    slow = [rate for rate in (1e-4, 1e-3, 1e-2, 0.1) if worst(rate) > 1e-6]
    if slow:
        return named("SLOW_TURN_AS_STRAIGHT") if all(map(straight, slow)) else None
    cancels = any(worst(rate) > 1e-6 and ragged(rate) for rate in (1e-13, 1e-12, 2e-12, 5e-12, 1e-11))
    return named("SMALL_TURN_CANCELS") if cancels else None


def _along(headings, way):
    return way * np.stack((np.cos(headings), np.sin(headings)), axis=1)
