"""What public and hidden checks of ``digital-twin`` have in common: one call, then the comparison."""

from __future__ import annotations

import itertools
import math

import numpy as np

from course.grading import kit

diagnosis = kit.companion("digital-twin", "diagnosis")
sensors = kit.companion("digital-twin", "sensor_probes")
actuators = kit.companion("digital-twin", "actuator_probes")
twins = kit.companion("digital-twin", "twin_probes")
new_twin = kit.companion("digital-twin", "scenes").new_twin

CALIBRATED = "200 seeds of every correct solution, tests/benchmarks/calibration/digital-twin.md"


def expect_clean(submission, task, args, names):
    """One call leaves its arguments alone and returns nothing that is theirs; its value."""
    inspected = submission.call_inspect(task, *args)
    for name, before, after in zip(names, args, inspected.args_after, strict=True):
        if name and not twins.same(before, after):
            kit.fail(
                f"The call changed its argument `{name}` in place.",
                diagnose=diagnosis.named("MUTATES_INPUT"),
                expected={name: before},
                actual={name: after},
            )
    if inspected.shared:
        kit.fail(
            "What the call returned is the caller's own array, not a new one.",
            diagnose=diagnosis.named("RETURNS_ARGUMENT"),
        )
    return inspected.value


def expect_counts(counts, theta, counts_per_rev):
    """Counts are whole numbers, and those of floor throughout or of round throughout."""
    given = {"theta": theta, "counts_per_rev": counts_per_rev}
    if isinstance(counts, list):
        whole = all(isinstance(count, int) and not isinstance(count, bool) for count in counts)
    else:
        whole = isinstance(counts, np.ndarray) and counts.dtype.kind == "i"
    values = kit.as_vector(counts, len(theta), "counts")
    exact = theta * counts_per_rev / (2 * math.pi)
    floor, nearest = np.floor(exact), np.rint(exact)
    wanted = floor if np.sum(values == floor) >= np.sum(values == nearest) else nearest
    kit.expect_array(
        values,
        wanted,
        abs=1e-9,
        source="counts are exact",
        quantity="counts",
        units="counts",
        input=given,
        message="The counts are neither the angles rounded down to whole counts nor rounded to nearest.",
        help="counts = theta * counts_per_rev / (2 pi), rounded the same way on both sides of zero.",
        diagnose=lambda: sensors.of_encoder(values, theta, counts_per_rev),
    )
    error = exact - values
    kit.expect_close(
        std(error),
        1 / math.sqrt(12),
        rel=0.1,  # a few hundred angles: the std of a uniform error scatters by 2 %
        source="std of an error spread evenly over one count, 0.289",
        quantity="std of the rounding error",
        units="counts",
        input=given,
        message="The rounding errors do not spread evenly over one count.",
    )
    kit.expect_true(
        whole,
        "The counts do not come as whole numbers.",
        input=given,
        diagnose=diagnosis.named("COUNTS_AS_FLOATS"),
    )


def std(values):
    """The std of what may hold anything; NaN where it has none."""
    with np.errstate(all="ignore"):
        return float(np.std(values))


def expect_std(values, expected, rel, source, message, diagnose, **finding):
    """The std of a sample is the expected one."""
    kit.expect_close(
        std(values),
        expected,
        rel=rel,
        source=source,
        units="rad/s",
        message=message,
        diagnose=diagnose,
        **finding,
    )


def imu_pairs(submission, calls):
    """(measured, bias) of each call, as vectors as long as the true rate."""
    pairs = []
    for call, value in zip(calls, submission.call_each("imu", calls), strict=True):
        measured, bias = kit.as_tuple(value, ("measured", "bias"))
        n = len(call[0])
        pairs.append((kit.as_vector(measured, n, "measured"), kit.as_vector(bias, n, "bias")))
    return pairs


def expect_fits(submission, cases, worst):
    """fit_noise recovers what recordings were made with.

    cases: (still, dt, noise_density, bias_random_walk, bias0) each
    worst: largest median over the cases of |log(N ratio)|, |log(K ratio)| and |bias0 error| / sqrt(N K). A
        median: whoever looks at few blocks is far off on a rare recording, and right about the method.
    """
    keys = ("noise_density", "bias_random_walk", "bias0")
    values = submission.call_each("fit_noise", [(still, dt) for still, dt, *_ in cases])
    found = [[kit.as_number(kit.as_record(value, keys)[key], key) for key in keys] for value in values]
    right = np.array([case[2:] for case in cases])
    with np.errstate(all="ignore"):
        off = np.log(np.array(found) / right)
        off[:, 2] = (np.array(found)[:, 2] - right[:, 2]) / np.sqrt(right[:, 0] * right[:, 1])
    off[~np.isfinite(off)] = np.inf
    looks = (
        lambda i: sensors.of_density(found[i][0], cases[i][0], cases[i][1], cases[i][2]),
        lambda i: sensors.of_walk(found[i][1], cases[i][3]),
        lambda i: sensors.of_bias0(found[i][2], cases[i][0]),
    )
    units = ("log of a ratio", "log of a ratio", "sqrt(N K)")
    for column, key in enumerate(keys):
        i = int(np.argmax(np.abs(off[:, column])))
        kit.expect_close(
            float(np.median(np.abs(off[:, column]))),
            0.0,
            abs=worst[column],
            source=CALIBRATED,
            quantity=f"median error of {key}",
            units=units[column],
            input={
                "dt": cases[i][1],
                "worst recording made with": dict(zip(keys, cases[i][2:], strict=True)),
                "found": found[i],
            },
            message=f"From recordings at rest, fit_noise does not find `{key}`.",
            help="Average over blocks of growing length and see how the spread of the means changes.",
            diagnose=lambda column=column, i=i: looks[column](i),
        )


def expect_follows(submission, twin, calls, truth, *, settled, frictions, message):
    """Fold ``sync`` through measurements; the twin keeps to the truth.

    settled: (from, to) where the position counts, s: not while the twin gets over a jump of the friction
    frictions: (from, to, right friction): the mean estimate between two times, s
    """
    folded = submission.fold("sync", twin, calls, keep=twins.scenes.SEEN)
    rows = twins.path(folded)[1:]
    late = any(b[1] < a[1] for a, b in itertools.pairwise(calls))
    ask = lambda: twins.of_sync(submission, late)  # noqa: E731
    kit.expect_array(
        rows[:, 0],
        truth[:, 0],
        abs=1e-9,
        source="rounding",
        quantity="t",
        units="s",
        t=truth[:, 0],
        message="The twin's time is not the latest time that it has heard of.",
        help='Return "t": max(twin["t"], t_measured).',
        diagnose=ask,
    )
    counts = np.any([(truth[:, 0] >= a) & (truth[:, 0] <= b) for a, b in settled], axis=0)
    with np.errstate(all="ignore"):
        off = rows[:, 1] - truth[:, 1]
        rms = float(np.sqrt(np.mean(off[counts] ** 2)))
    kit.expect_bounded(
        rms,
        high=0.02,
        source="two stds of a single measurement; " + CALIBRATED,
        quantity="rms error of the position",
        units="m",
        input={"measurements": len(calls), "sigma": twin["sigma"], "twin": twin},
        message=message,
        help="Predict first, then correct position, speed and friction by shares of the surprise.",
        diagnose=ask,
    )
    for start, stop, friction in frictions:
        window = (truth[:, 0] >= start) & (truth[:, 0] <= stop)
        with np.errstate(all="ignore"):
            believed = float(np.mean(rows[window, 3]))
        kit.expect_close(
            believed,
            friction,
            rel=0.1,
            source="the contract's 10 %; " + CALIBRATED,
            quantity="friction",
            units="1/s",
            input={"from": start, "to": stop, "sigma": twin["sigma"]},
            message="The twin keeps up with the position, but it has not found the friction behind it.",
            help="A surprise that keeps its sign says that the friction is wrong.",
            diagnose=ask,
        )
    return folded


def expect_play(submission, inputs, gap, states, outputs):
    """``backlash`` from each of these states gives that output, as y and as the next state."""
    values = submission.call_each("backlash", list(zip(inputs, [gap] * len(inputs), states, strict=True)))
    pairs = [kit.as_tuple(value, ("y", "state_next")) for value in values]
    for column, name in enumerate(("y", "state_next")):
        kit.expect_array(
            [kit.as_number(pair[column], name) for pair in pairs],
            outputs,
            abs=1e-12,
            source="rounding",
            quantity=name,
            t=np.arange(len(inputs)),  # the number of the input stands for its time
            input={"x": inputs, "gap": gap, "state": states},
            message="The output of the gear is not its old output, pushed by the edges of the gap.",
            help="y is the state, clipped to [x - gap/2, x + gap/2], and so is the next state.",
            diagnose=lambda: actuators.of_backlash(submission),
        )


def expect_delayed(value, x, dt, latency, expected):
    """A signal comes out late; samples whose time is zero but for rounding may be either side of it."""
    y = kit.as_vector(value, len(x), "the delayed signal")
    t = dt * np.arange(len(x))
    edge = np.abs(t - latency) < 1e-6 * dt
    kit.expect_array(
        np.where(edge, expected, y),
        expected,
        abs=1e-9,
        source="rounding",
        quantity="y",
        t=t,
        input={"x": x, "dt": dt, "latency": latency},
        message="What comes out is not the signal of latency ago.",
        help="At time k dt look at k dt - latency: between two samples on their line, before all 0.0.",
        diagnose=lambda: actuators.of_delay(y, x, dt, latency),
    )


def arc_end(pose, v_left, v_right, track, dt):
    """Where the exact arc ends, by its two radii; not for turns so slow that they cancel."""
    turn = (v_right - v_left) / track * dt
    radius = track / 2 * (v_left + v_right) / (v_right - v_left)
    x, y, heading = pose
    return np.array(
        [
            x + radius * (math.sin(heading + turn) - math.sin(heading)),
            y - radius * (math.cos(heading + turn) - math.cos(heading)),
            heading + turn,
        ]
    )


def expect_pose(submission, value, pose, rest, expected, abs_=1e-9, source="rounding"):
    """One step of the robot ends there."""
    kit.expect_array(
        kit.as_vector(value, 3, "the pose"),
        expected,
        abs=abs_,
        source=source,
        quantity="pose",
        units="m, m, rad",
        input={"pose": pose, **dict(zip(("v_left", "v_right", "track", "dt"), rest, strict=True))},
        message="After one step, the robot is not where the arc of its two wheels ends.",
        help="The axle's middle goes at the mean speed; the turn rate is the difference over the track.",
        diagnose=lambda: actuators.of_drive(submission),
    )


def expect_drives(submission, cases):
    """``command`` at a twin that has the target speed already: friction times speed.

    cases: (friction, target speed)
    """
    calls = [(new_twin(b, 0.9 * b, speed=target), target) for b, target in cases]
    values = [kit.as_number(value, "the drive") for value in submission.call_each("command", calls)]
    kit.expect_array(
        values,
        [b * target for b, target in cases],
        abs=1e-9,
        source="rounding",
        quantity="drive",
        units="m/s²",
        input={"friction, target speed": cases},
        message="At the target speed, the drive does not balance the friction that the twin believes in.",
        help="There dv/dt = drive - friction * speed has to be zero.",
        diagnose=lambda: twins.of_command(submission),
    )
