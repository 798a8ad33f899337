"""What public and hidden checks of actuators and odometry of ``digital-twin`` have in common."""

from __future__ import annotations

import math

import numpy as np

from course.scoring import kit

actuators = kit.companion("digital-twin", "actuator_probes")
bundles = kit.companion("digital-twin", "bundles")
expect_clean = bundles.expect_clean


def expect_play(submission, inputs, gap, states, outputs):
    """``backlash`` from each of these states gives that output, as y and as the next state.

    gap: one for all, or one for each
    """
    gaps = np.broadcast_to(gap, len(inputs)).tolist()
    values = submission.call_each("backlash", list(zip(inputs, gaps, states, strict=True)))
    pairs = [kit.as_tuple(value, ("y", "state_next")) for value in values]
    for column, name in enumerate(("y", "state_next")):
        found = [kit.as_number(pair[column], name) for pair in pairs]
        wrong = np.flatnonzero(~(np.abs(np.subtract(found, outputs)) <= 1e-9))
        step = int(wrong[0]) if len(wrong) else 0
        kit.expect_array(
            found,
            outputs,
            abs=1e-9,
            source="rounding",
            quantity=name,
            input={"step": step, "x": inputs[step], "gap": gaps[step], "state": states[step]},
            message="The output of the gear is not its old output, clipped to the gap around the input."
            if name == "y"
            else "The output is right, but the next state is not the same number.",
            help="y is the state, clipped to [x - gap/2, x + gap/2], and so is the next state.",
            diagnose=lambda refuted={"STATE_IS_NOT_OUTPUT"} if name == "y" else (): bundles.unless(
                refuted, lambda: actuators.of_backlash(submission)
            ),
        )


def expect_delayed(submission, value, x, dt, latency, expected):
    """A signal comes out late; samples whose time is zero but for rounding may be either side of it."""
    y = kit.as_vector(value, len(x), "the delayed signal")
    t = dt * np.arange(len(x))
    beyond = latency > t[-1]
    wrong = ~(np.abs(y - expected) <= 1e-9)
    arrived = np.any(wrong) and t[np.argmax(wrong)] > latency + 1e-6 * dt
    refuted = {"DELAY_HOLDS_FIRST"} if arrived else ()
    edge = (np.abs(t - latency) < 1e-6 * dt) & (latency > 0)
    kit.expect_array(
        np.where(edge, expected, y),
        expected,
        abs=1e-9,
        source="rounding",
        quantity="y",
        t=t,
        input={"x": x, "dt": dt, "latency": latency},
        message="With a latency beyond the last sample, the output is not all zeros."
        if beyond
        else "The output is not the signal delayed by the latency.",
        help="At time k*dt take the signal of k*dt - latency: interpolated between samples, 0.0 before "
        "the first.",
        diagnose=lambda: bundles.unless(refuted, lambda: actuators.of_delay(submission)),
    )


def expect_new_signal(submission, x, dt):
    """Without latency and with one, what comes out is an array of its own, and the signal is left alone."""
    half_way = np.concatenate([[0.0, 0.0], (x[1:-1] + x[:-2]) / 2])  # after one and a half samples
    for latency, expected in ((0.0, x), (1.5 * dt, half_way)):
        value = expect_clean(submission, "delay_line", (x, dt, latency), ("x", None, None))
        expect_delayed(submission, value, x, dt, latency, expected)


def motor_speed(w, u, dt, tau, u_max, dead):
    """Where the lag takes a motor from the speed w."""
    goal = float(np.clip(u, -u_max, u_max)) * (abs(u) > dead)
    return goal + (w - goal) * math.exp(-dt / tau)


def expect_motors(submission, first, second):
    """Of two motors, single steps of the first, and of it with each number of the second in turn."""
    calls = bundles.one_by_one(first, second)
    kit.expect_array(
        [kit.as_number(value, "w_next") for value in submission.call_each("motor_step", calls)],
        [motor_speed(*call) for call in calls],
        abs=1e-9,
        source="rounding",
        quantity="w",
        units="rad/s",
        input={"(w, u, dt, tau, u_max, deadband)": calls},
        message="In single steps that differ in one number each, the speed of the motor is wrong.",
        help="Apply to the command itself, with the numbers of this call: dead band, saturation, then the "
        "exact lag.",
        diagnose=lambda: actuators.of_motor(submission),
    )


def expect_motor(submission, w, calls, message, source="rounding"):
    """A motor goes through these commands (u, dt, tau, u_max, deadband) as theory says, from the speed w."""
    found = submission.fold("motor_step", w, calls)[1:]
    found = [kit.as_number(value, "w_next") for value in found]
    expected = []
    for call in calls:
        w = motor_speed(w, *call)
        expected.append(w)
    wrong = np.flatnonzero(~(np.abs(np.subtract(found, expected)) <= 1e-9))
    u, *_, dead = calls[wrong[0] if len(wrong) else 0]
    refuted = {"DEADBAND_WIDTH"} if abs(u) >= 4 * dead else ()  # four times as far, the probe saw it move
    kit.expect_array(
        found,
        expected,
        abs=1e-9,
        source=source,
        quantity="w",
        units="rad/s",
        t=np.cumsum([dt for _, dt, *_ in calls]),
        input={"(u, dt, tau, u_max, deadband)": calls},
        message=message,
        help="Apply to the command itself, in this order: dead band, saturation, then the exact lag, "
        "starting from the present speed.",
        diagnose=lambda: bundles.unless(
            refuted, lambda: actuators.of_motor(submission), lambda: actuators.of_speed_limit(submission)
        ),
    )


#: What the README allows of the position after one step, m, and of the heading, rad. Arcs by their radius
#: lose up to 1e-6 m to cancelling sines at the best threshold, and 1e-4 m and more without one.
POSITION_WITHIN, HEADING_WITHIN = 1e-5, 1e-9


def arc_end(pose, wheels):
    """Where a robot is after one step; wheels: (v_left, v_right, track, dt).

    Where the turn is not slow, the end of the exact arc by its radius; else the chord by its series, whose
    next term is below 1e-11 of the way.
    """
    v_left, v_right, track, dt = wheels
    x, y, heading = pose
    turn, way = (v_right - v_left) / track * dt, (v_left + v_right) / 2 * dt
    if abs(turn) < 0.03:
        chord, middle = way * (1 - turn**2 / 24 + turn**4 / 1920), heading + turn / 2
        return np.array([x + chord * math.cos(middle), y + chord * math.sin(middle), heading + turn])
    dx = way / turn * (math.sin(heading + turn) - math.sin(heading))
    dy = -way / turn * (math.cos(heading + turn) - math.cos(heading))
    return np.array([x + dx, y + dy, heading + turn])


_OF_SLOW_TURNS = {"SMALL_TURN_CANCELS", "SLOW_TURN_AS_STRAIGHT", "STRAIGHT_WRONG", "STRAIGHT_DIVIDES_BY_ZERO"}
_OF_POSITION = {"CHORD_WRONG_WAY", "CHORD_WRONG_LENGTH", "Y_MIRRORED"}


def expect_pose(submission, value, pose, wheels, expected=None):
    """One step of the robot ends there; where nothing is given, at the end of its arc."""
    end = kit.as_vector(value, 3, "the pose")
    expected = arc_end(pose, wheels) if expected is None else np.asarray(expected)
    v_left, v_right, track, dt = wheels
    fast = _OF_SLOW_TURNS if abs(v_right - v_left) / track * dt > 1.5 else set()  # the probe's turn is right
    for part, limit, units in ((slice(2), POSITION_WITHIN, "m"), (slice(2, 3), HEADING_WITHIN, "rad")):
        kit.expect_array(
            end[part],
            expected[part],
            abs=limit,
            source="the README's",
            quantity="position" if units == "m" else "heading",
            units=units,
            input={"pose": pose, **dict(zip(("v_left", "v_right", "track", "dt"), wheels, strict=True))},
            message="After one step, the robot is not where the arc of its two wheels ends."
            if units == "m"
            else "After one step, the heading is not the old one plus the turn of the two wheels.",
            help="Compute turn = dt (v_right - v_left)/track by hand, then the chord, x, y and the heading, "
            "as in the README. Which is the first that differs?",
            diagnose=lambda units=units: bundles.unless(
                fast if units == "m" else _OF_POSITION,
                lambda: actuators.of_drive(submission, heading=units == "rad"),
            ),
        )


def expect_slow_turns(submission, rng):
    """As the turn rate goes to zero, the arc goes over into a straight line."""
    # One in each decade of the slow ones: whatever is taken for straight, one just below it is asked for.
    decades = np.arange(-11, -1) + rng.uniform(0, 1, 10)
    # Rounding spoils a radius most where it is longest, and there at some headings only: many are asked for.
    rates = [0.0, 0.0, *(10.0 ** rng.uniform(-14, -11, 24)), *(10.0**decades)]
    track = rng.uniform(0.3, 0.8)
    calls = []
    for rate in rates:
        v, half = rng.uniform(0.2, 0.9), rng.choice([-1, 1]) * rate * track / 2
        calls.append((rng.uniform(-2, 2, 3), v - half, v + half, track, rng.uniform(0.5, 2.0)))
    first, second = ((rng.uniform(-2, 2, 3), *rng.uniform(0.2, 0.8, 4)) for _ in range(2))
    for turn in (0.0195, 0.049, 0.098):  # just below round limits, and so far that a straight line is off
        half = rng.choice([-1, 1]) * turn / 2.0 * track / 2
        calls.append((rng.uniform(-2, 2, 3), 0.9 - half, 0.9 + half, track, 2.0))
    calls += bundles.one_by_one(first, second)
    for call, value in zip(calls, submission.call_each("diff_drive_step", calls), strict=True):
        expect_pose(submission, value, call[0], call[1:])
