"""What your functions of ``digital-twin`` make of a replay: the twin's drift and return, a drive, a scan."""

from __future__ import annotations

import math

import numpy as np

from course.scoring import kit

scenes = kit.companion("digital-twin", "scenes")
drive = kit.companion("digital-twin", "drive")

_JUMP = ((0.0, 0.5), (20.0, 0.8))  # the wheels begin to rub after 20 s
_TARGET = 1.0  # m/s


def report(submission):
    """Everything there is to see; sections of functions not yet written say so."""
    parts = (
        ("A copy that drifts, and your twin", lambda: _replay(submission)),
        ("Both directions", lambda: _loop(submission)),
        ("A drive round the room", lambda: drive.section(submission)),
        ("A scan", lambda: _scan(submission)),
        ("A gyroscope at rest", lambda: _at_rest(submission)),
        ("Actuators", lambda: _actuators(submission)),
    )
    return kit.Report(
        title="A digital twin of a mobile robot",
        sections=tuple(kit.guarded_section(title, make) for title, make in parts),
        streams=drive.streams(submission),
    )


def _rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


def _folded(submission, twin, calls):
    """Rows t, position, speed, friction after each measurement, fifty to a message; and the last twin."""
    rows = []
    for start in range(0, len(calls), 50):
        folded = submission.fold("sync", twin, calls[start : start + 50])
        values = [kit.as_record(value, scenes.KEYS, "the twin") for value in folded[1:]]
        rows += [[kit.as_number(value[key], key) for key in scenes.KEYS[:4]] for value in values]
        twin = folded[-1]
    return np.array(rows), twin


def _replay(submission):
    """One minute with a fixed drive: a copy that is never measured, and the student's twin."""
    cart = scenes.Cart(_JUMP, v=_TARGET)
    times = 0.1 * np.arange(1, 601)
    run = scenes.measured(cart, 0.5, times, np.random.default_rng(7), late=0.15)
    calls, truth = run.calls, run.truth
    t = truth[:, 0]
    alone = scenes.Cart(((0.0, 0.5),), v=_TARGET)
    unmeasured = []
    for moment in t:
        alone.roll(0.5, moment)
        unmeasured.append(alone.x)
    lost, late = np.array(unmeasured) - truth[:, 1], t > 50.0
    off_panel = [kit.Series("never measured", t, np.maximum(np.abs(lost), 1e-4))]
    believed = [kit.Series("true", [0.0, 20.0, 20.0, 60.0], [0.5, 0.5, 0.8, 0.8], quiet=True)]
    table = [("never measured", f"{_rms(lost[late]):.2f} m", "0.50 1/s")]
    seen = "your twin is still to be written"
    followed = kit.attempt(lambda: _folded(submission, scenes.new_twin(0.5, 0.5, speed=_TARGET), calls))
    if followed is not None:
        rows = followed[0]
        off, friction = rows[:, 1] - truth[:, 1], float(np.mean(rows[late, 3]))
        off_panel.append(kit.Series("your twin", t, np.maximum(np.abs(off), 1e-4)))
        believed.append(kit.Series("your twin", t, rows[:, 3]))
        table.append(("your twin", f"{1000 * _rms(off[late]):.1f} mm", f"{friction:.2f} 1/s"))
        seen = f"your twin ends {1000 * _rms(off[late]):.0f} mm off and believes in {friction:.2f} 1/s"
    off_panel.append(kit.Series("one measurement, std", [0.0, 60.0], [scenes.SIGMA] * 2, quiet=True))
    return kit.Section(
        "A copy that drifts, and your twin",
        text="A cart rolls for a minute under a fixed drive; after 20 s its wheels start to rub. A copy that "
        "is never corrected keeps the old friction. Your twin gets ten positions a second, one "
        "in seven of them late" + ("." if followed else "; `sync` is still to be written."),
        columns=("copy", "off in the last 10 s", "friction"),
        rows=(*table, ("the cart", "", "0.80 1/s")),
        plot=kit.Plot(
            "How far the copy and your twin are off, and the friction they believe in",
            (
                kit.Panel("time / s", "off by / m", tuple(off_panel), title="Where is the cart?", log="y"),
                kit.Panel("time / s", "friction / (1/s)", tuple(believed), title="Why is it slow?"),
            ),
            "Upper panel: distance from the cart on a logarithmic axis; the unmeasured copy runs away after "
            f"20 s. Lower panel: the friction, which jumps at 20 s. In numbers, {seen}.",
        ),
    )


def _loop(submission):
    """The same minute, the drive set once a second by the student's command from the student's twin."""
    rng = np.random.default_rng(8)
    cart, fixed = scenes.Cart(_JUMP, v=_TARGET), scenes.Cart(_JUMP, v=_TARGET)
    twin = scenes.new_twin(0.5, 0.5, speed=_TARGET)
    speeds, planned = [], []
    for second in range(60):
        run = scenes.measured(cart, twin["drive"], second + 0.1 * np.arange(1, 11), rng)
        truth, (_, twin) = run.truth, _folded(submission, twin, run.calls)
        twin = {**twin, "drive": kit.as_number(submission.call("command", twin, _TARGET), "the drive")}
        speeds += truth[:, 2].tolist()
        for moment in truth[:, 0]:
            fixed.roll(0.5, moment)
            planned.append(fixed.v)
    t, speeds = 0.1 * np.arange(1, 601), np.array(speeds)
    dip, end = float(np.min(speeds[200:])), float(np.mean(speeds[-100:]))
    panel = kit.Panel(
        "time / s",
        "speed / (m/s)",
        (
            kit.Series("drive as planned", t, planned),
            kit.Series("drive from your twin", t, speeds),
            kit.Series("asked for", [0.0, 60.0], [_TARGET] * 2, quiet=True),
        ),
    )
    return kit.Section(
        "Both directions",
        text="The same cart, and once a second your command sets its drive from your twin. A twin "
        "that learns the new friction brings the cart back to its speed.",
        columns=("drive", "slowest after 20 s", "last 10 s"),
        rows=(
            ("as planned", f"{min(planned[200:]):.2f} m/s", f"{np.mean(planned[-100:]):.2f} m/s"),
            ("from your twin", f"{dip:.2f} m/s", f"{end:.2f} m/s"),
        ),
        plot=kit.Plot(
            "The speed of the cart, driven as planned and by your twin",
            (panel,),
            f"Speed over a minute; with the planned drive it stays at {np.mean(planned[-100:]):.2f} m/s "
            f"after 20 s, with the twin's it dips to {dip:.2f} and ends at {end:.2f} m/s.",
        ),
    )


def _scan(submission):
    """One noisy scan of the room, drawn where the robot believes its walls to be."""
    pose, angles, r_max = np.array([2.2, 1.6, 0.4]), np.linspace(-math.pi, math.pi, 180, endpoint=False), 4.5
    value = submission.call("lidar", pose, scenes.ROOM, angles, r_max, 0.03, np.random.default_rng(2))
    ranges = kit.as_vector(value, len(angles), "ranges")
    beams, hit = pose[2] + angles, ranges < r_max
    x, y = pose[0] + ranges * np.cos(beams), pose[1] + ranges * np.sin(beams)
    off = ranges - scenes.room_ranges(pose, angles, r_max)
    walls = [kit.Series("walls" if i == 0 else "", *wall.T, quiet=True) for i, wall in enumerate(scenes.ROOM)]
    dots = kit.Series("hits", x[hit], y[hit], "points")
    robot = kit.Series("robot", pose[:1], pose[1:2], "points")
    spread = 1000 * float(np.std(off[hit]))
    return kit.Section(
        "A scan",
        text=f"{hit.sum()} of {len(angles)} beams hit a wall, {spread:.0f} mm off (std; required: 30). The "
        "others point through the door or exceed their range.",
        plot=kit.Plot(
            "Where your beams end",
            (kit.Panel("x / m", "y / m", (*walls, dots, robot), equal=True),),
            f"The room from above with {hit.sum()} hits scattered {spread:.0f} mm about its walls; none "
            "where the door is.",
        ),
    )


def _at_rest(submission):
    """What fit_noise finds in a recording that the student's imu made."""
    made, dt = {"noise_density": 0.002, "bias_random_walk": 0.003, "bias0": 0.05}, 0.01
    value = submission.call("imu", np.zeros(12000), dt, *made.values(), np.random.default_rng(5))
    still, bias = (kit.as_vector(part, 12000, "imu") for part in kit.as_tuple(value, ("measured", "bias")))
    found = submission.call("fit_noise", still, dt)
    found = kit.as_record(found, tuple(made))
    units = ("rad/s/√Hz", "rad/s/√s", "rad/s")
    t, every = dt * np.arange(12000), slice(None, None, 20)
    series = (
        kit.Series("measured, each 20th", t[every], still[every], "points", quiet=True),
        kit.Series("bias", t[every], bias[every]),
    )
    return kit.Section(
        "A gyroscope at rest",
        text="Two minutes of your imu, lying still, and what your fit_noise makes of it.",
        columns=("quantity", "made with", "found"),
        rows=tuple(
            (key, f"{made[key]:g} {unit}", f"{kit.as_number(found[key], key):.3g} {unit}")
            for key, unit in zip(made, units, strict=True)
        ),
        plot=kit.Plot(
            "White noise hides a bias that drifts",
            (kit.Panel("time / s", "turn rate / (rad/s)", series),),
            f"Samples over two minutes, {np.std(still - bias):.3g} rad/s (std) about a bias that starts at "
            f"{bias[0]:.3g} rad/s, ends at {bias[-1]:.3g} and lies between {bias.min():.3g} and "
            f"{bias.max():.3g}.",
        ),
    )


def _crest(signal):
    """Where a signal of two swings is largest in the second one."""
    half = len(signal) // 2
    return half + int(np.argmax(signal[half:]))


def _actuators(submission):
    """A command through motor, play and delay."""
    dt, n = 0.02, 200
    t = dt * np.arange(n)
    command = 8.0 * np.sin(2 * math.pi * t / 2.0)
    calls = [(float(u), dt, 0.15, 6.0, 1.0) for u in command]
    speed = [kit.as_number(w, "w_next") for w in submission.fold("motor_step", 0.0, calls)[1:]]
    late = kit.as_vector(submission.call("delay_line", np.array(speed), dt, 0.13), n, "the delayed signal")
    angle, state, played = dt * np.cumsum(late), 0.0, []
    for x in angle:
        pair = kit.as_tuple(submission.call("backlash", float(x), 0.6, state), ("y", "state_next"))
        y, state = (kit.as_number(part, "y") for part in pair)
        played.append(y)
    above = kit.Panel(
        "time / s",
        "speed / (rad/s)",
        (
            kit.Series("command", t, command, quiet=True),
            kit.Series("motor", t, speed),
            kit.Series("0.13 s later", t, late),
        ),
    )
    below = kit.Panel(
        "time / s",
        "angle / rad",
        (kit.Series("before the gear", t, angle), kit.Series("behind 0.6 rad of play", t, played)),
    )
    return kit.Section(
        "Actuators",
        text="A swinging command, larger than the motor takes: dead band, saturation and lag, then a delay, "
        "then a gear with play.",
        plot=kit.Plot(
            "The motion differs from the command",
            (above, below),
            "Upper panel, the second of two swings: the command is largest at "
            f"{t[_crest(command)]:.2f} s, with {command[_crest(command)]:.1f} rad/s, your motor at "
            f"{t[_crest(speed)]:.2f} s, with {speed[_crest(speed)]:.1f}, and your delayed signal at "
            f"{t[_crest(late)]:.2f} s. Lower panel: the angle covers {np.ptp(angle):.2f} rad before the gear "
            f"and {np.ptp(played):.2f} rad behind it.",
        ),
    )
