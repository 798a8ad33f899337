"""What public and hidden checks of ``sync`` and ``command`` of ``digital-twin`` have in common."""

from __future__ import annotations

import numpy as np

from course.scoring import kit

bundles = kit.companion("digital-twin", "bundles")
scenes = kit.companion("digital-twin", "scenes")
twins = kit.companion("digital-twin", "twin_probes")
new_twin = scenes.new_twin


#: The rms error of the twin's position over that of the measurements themselves: after those that came
#: in time, and after late ones. In time, passing z on is 1; constant shares reach 0.37 to 0.78 and Kalman
#: filters 0.34 to 0.75 over 400 runs. After late ones, which are fewer, right twins reach up to 0.93.
FOLLOWS_WITHIN, FOLLOWS_LATE_WITHIN = 0.85, 1.25
#: m/s, rms: right twins reach 0.014 to 0.031 over 240 runs, differences of the measurements 0.28 and more.
SPEED_WITHIN = 0.1


def _rms(values):
    return float(np.sqrt(np.mean(np.square(values)))) if len(values) else 0.0


def _of_sync(submission, late, backwards, driven=False, stops=False):
    """The mistake of ``sync`` in a check whose measurements may be late and whose cart may roll backwards.

    driven: whether measurements may be late after another drive has begun
    """
    refuted = set() if late else {"LATE_USED_AS_CURRENT", "LATE_STATE_AS_CURRENT", "TIME_RUNS_BACK"}
    refuted |= set() if driven else {"PAST_WITH_NEW_DRIVE", "FRICTION_SIGN_OF_DRIVE"}
    refuted |= set() if backwards else {"LEARNS_FORWARDS_ONLY", "FRICTION_HELD_BACKWARDS"}
    return twins.of_sync(submission, refuted, stops)


def _folded(submission, twin, calls, **kept):
    """The twins along these calls; where one fails, first whether a twin has all that the next call needs."""
    try:
        return submission.fold("sync", twin, calls, **kept)
    except kit.StudentFailure:
        twins.states([submission.call("sync", twin, *calls[0])])
        raise


def _along(submission, twin, run):
    """The twins along a run, the first one before it; between two calls the caller may set another drive."""
    starts = np.flatnonzero(np.append(True, np.diff(run.drives) != 0.0))
    folded = [twin]
    for start, stop in zip(starts, np.append(starts[1:], len(run.calls)), strict=True):
        twin = kit.as_record(folded.pop(), scenes.KEYS, "the twin") | {"drive": float(run.drives[start])}
        part = _folded(submission, twin, run.calls[start:stop], keep=scenes.SEEN)
        if not start:
            _expect_no_foresight(submission, twin, run.calls[start:stop], part)
        folded += [{key: twin[key] for key in scenes.SEEN}, *part[1:]]
    return folded


def _expect_no_foresight(submission, twin, calls, folded):
    """A twin is the same whatever is measured after it.

    All measurements of a stretch cross to the student's process at once, and a program that looks around
    there finds those to come.
    """
    few = calls[: len(calls) // 4]
    alone = _folded(submission, twin, few, keep=scenes.SEEN)[-1]
    seen = folded[len(few)]
    kit.expect_true(
        all(twins.same(alone[key], seen[key]) for key in scenes.SEEN),
        "Asked again, with the first of these measurements alone, the twin is another one.",
        help="A twin follows from the one before and from one measurement: keep what it needs in its memory, "
        "and nothing anywhere else.",
        diagnose=lambda: twins.of_memory(submission),
        input={"measurements": len(few)},
        expected={key: alone[key] for key in scenes.SEEN},
        actual={key: seen[key] for key in scenes.SEEN},
    )


def expect_follows(submission, twin, run, *, settled, frictions, message):
    """Fold ``sync`` through measurements; the twin keeps to the truth, and better than they do.

    run: a ``scenes.Run``
    settled: (from, to) where the position counts, s: not while the twin gets over a jump of the friction
    frictions: (from, to, right friction): the mean estimate between two times, s
    """
    calls, truth = run.calls, run.truth
    folded = _along(submission, twin, run)
    rows = twins.path(folded)[1:]
    late, driven = bool(np.any(run.late)), bool(np.ptp(run.drives) > 0)
    windows = [(truth[:, 0] >= a) & (truth[:, 0] <= b) & ~run.late for a, b, _ in frictions]
    stops = any(twins.stops(rows[window, 3], end) for window in windows for end in (0, -1))
    backwards = bool(np.any(truth[:, 2] < 0))
    ask = lambda: _of_sync(submission, late, backwards, late and driven, stops)  # noqa: E731
    _expect_no_flight(rows, {"measurements": len(calls), "twin": twin}, ask)
    kit.expect_array(
        rows[:, 0],
        truth[:, 0],
        abs=1e-9,
        source="rounding",
        quantity="t",
        units="s",
        t=truth[:, 0],
        message="The twin's time is not the latest time that it has received.",
        help='Return "t": max(twin["t"], t_measured).',
        diagnose=ask,
    )
    counts = np.any([(truth[:, 0] >= a) & (truth[:, 0] <= b) for a, b in settled], axis=0)
    sensor = _rms(run.errors[counts & ~run.late])
    for when, limit in ((~run.late, FOLLOWS_WITHIN), (run.late, FOLLOWS_LATE_WITHIN)):
        with np.errstate(all="ignore"):
            rms = _rms((rows[:, 1] - truth[:, 1])[counts & when])
        kit.expect_bounded(
            rms,
            high=limit * sensor,
            source="the README's share of the measurements' own",
            quantity="rms error of the position",
            units="m",
            input={"measurements": len(calls), "rms error of the measurements": sensor, "twin": twin},
            message=message,
            help="Print the surprises, and what each one changes. If some are far beyond sigma, was the "
            "position predicted for that time, with the drive of that time? If not, how much of each does "
            "the position take? Does the friction come closer to the cart's, whatever the drive is?",
            diagnose=ask,
        )
    with np.errstate(all="ignore"):
        speed_rms = _rms((rows[:, 2] - truth[:, 2])[counts])
    kit.expect_bounded(
        speed_rms,
        high=SPEED_WITHIN,
        source="the README's",
        quantity="rms error of the speed",
        units="m/s",
        input={"measurements": len(calls), "twin": twin},
        message="The position is within its limit, but the speed is further off than the README allows.",
        help="Print the speed before and after each correction. Does the prediction follow the drive and the "
        "friction, and how much of each surprise does the speed take?",
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
            source="the README's",
            quantity="friction",
            units="1/s",
            input={"from": start, "to": stop, "sigma": twin["sigma"]},
            message="Position and speed are within their limits, but the mean friction over some seconds is "
            "further off than the README allows.",
            help="Surprises that keep the same sign for long are often those of a wrong friction.",
            diagnose=ask,
        )
    return folded


#: s, m, m/s, 1/s. What is right here is below 40: a twin beyond it has run away, and is soon infinite.
_FLOWN = 1e6


def _expect_no_flight(rows, given, ask):
    """The twin does not run away by and by; one that is nan from one step to the next is no such twin."""
    with np.errstate(all="ignore"):
        beyond = ~(np.abs(rows) < _FLOWN)
    gone = np.flatnonzero(beyond.any(axis=1))
    if not len(gone):
        return
    first = int(gone[0])
    which = [key for key, far in zip(scenes.SEEN, beyond[first], strict=True) if far]
    values = dict(zip(which, rows[first, beyond[first]].tolist(), strict=True))
    grew = np.abs(rows[max(first - 3, 0) : first]).max(initial=0.0) > 1e2
    if grew or np.all(np.isfinite(rows[first])):
        kit.fail(
            "The twin runs away: a number of its state is beyond a million, or not finite.",
            help='Return "t": max(twin["t"], t_measured).'
            if "t" in which
            else "Print the first twins, before and after each correction: with each surprise position, "
            "speed and friction have to come closer to the cart's, forwards and backwards.",
            diagnose=ask,
            input={**given, "measurement": first},
            expected={"at most": _FLOWN},
            actual={"last before that": rows[max(first - 1, 0)], **values},
        )


def expect_drives(submission, cases):
    """``command`` at a twin that has the target speed already: friction times speed.

    cases: (friction, target speed)
    """
    calls = [(new_twin(b, 0.9 * b, speed=target), target) for b, target in cases]
    bundles.expect_clean(submission, "command", calls[0], ("twin", None))
    values = [kit.as_number(value, "the drive") for value in submission.call_each("command", calls)]
    kit.expect_array(
        values,
        [b * target for b, target in cases],
        abs=1e-9,
        source="rounding",
        quantity="drive",
        units="m/s²",
        input={"friction, target speed": cases},
        message="At the target speed, the drive does not balance the twin's friction.",
        help="At that speed dv/dt = drive - friction * speed must be zero.",
        diagnose=lambda: bundles.unless(_OF_CORRECTION, lambda: twins.of_command(submission)),
    )


#: At the target speed a correction is zero, whatever is wrong with it.
_OF_CORRECTION = {"PUSHES_AWAY", "GAIN_TOO_LARGE", "CORRECTION_JUMPS"}


def jump(rng):
    """Two frictions, 1/s, the second clearly another one."""
    first = rng.uniform(0.6, 0.8)
    return first, first * (rng.uniform(1.35, 1.6) if rng.uniform() < 0.5 else rng.uniform(0.62, 0.74))


def expect_keeps_up(submission, rng, *, sign, late, message):
    """27 s at a steady drive, the friction jumping after 9 s; the twin starts a little off.

    sign: 1.0 forwards, -1.0 backwards
    late: share of the measurements that arrive late
    """
    before, after = jump(rng)
    speed, sigma = sign * rng.uniform(0.8, 1.2), rng.uniform(1.0, 1.5) * scenes.SIGMA
    cart = scenes.Cart(((0.0, before), (9.0, after)), v=speed)
    run = scenes.measured(cart, before * speed, scenes.moments(rng, 27.0), rng, late=late, sigma=sigma)
    off = rng.uniform(-0.03, 0.03, 2)
    guess = before * rng.uniform(0.75, 1.33)
    twin = new_twin(guess, before * speed, speed=speed + off[0], position=off[1], sigma=sigma)
    expect_follows(
        submission,
        twin,
        run,
        settled=((5.0, 9.0), (15.0, 27.0)),
        frictions=((17.0, 27.0, after),),
        message=message,
    )


def expect_follows_drives(submission, rng):
    """26 s, either way; from 5 s on the drive changes about once a second, while measurements come late.

    In two seconds of three it pushes against the motion: who learns by its sign learns wrongly then. Such a
    friction was right after 20 s with one seed in a hundred, and never over the last 7 s of 26.
    """
    friction, sign, sigma = (
        rng.uniform(0.4, 0.8),
        rng.choice([-1.0, 1.0]),
        rng.uniform(1.0, 1.5) * scenes.SIGMA,
    )
    speed = sign * rng.uniform(0.9, 1.3)
    times, steady = scenes.moments(rng, 26.0), friction * speed
    begins = np.arange(5.0, 26.0) + rng.uniform(-0.1, 0.1, 21)
    pushes = sign * rng.uniform(1.2, 1.8, 21) * np.tile([-1.0, -1.0, 2.0], 7)
    drives = np.append(steady, steady + pushes)[np.searchsorted(begins, times)]
    run = scenes.measured(
        scenes.Cart(((0.0, friction),), v=speed), drives, times, rng, late=0.33, sigma=sigma
    )
    off = rng.uniform(-0.03, 0.03, 2)
    guess = friction * rng.uniform(0.75, 1.33)
    expect_follows(
        submission,
        new_twin(guess, steady, speed=speed + off[0], position=off[1], sigma=sigma),
        run,
        settled=((5.0, 26.0),),
        frictions=((12.0, 19.0, friction), (19.0, 26.0, friction)),
        message="With a drive that changes while some measurements are late, the twin's position is further "
        "off than the README allows.",
    )


def expect_twin_contract(submission, rng):
    """The same call gives the same twin again, the old one is kept as it is, and its memory stays small.

    The old twin is looked at after each kind of call: the first, one in time, a late one, and one in time
    after somebody has changed the drive.
    """
    friction, sign = rng.uniform(0.4, 0.9), rng.choice([-1.0, 1.0])
    cart = scenes.Cart(((0.0, friction),), v=sign)
    run = scenes.measured(cart, sign * friction, scenes.moments(rng, 16.0), rng, late=0.3)
    twin = new_twin(0.6, sign * friction, speed=sign)
    _expect_small_memory(submission, twin, run.calls)
    in_time, late = (int(np.flatnonzero(run.late == when)[5]) for when in (False, True))
    picks = [late, 3, in_time, 3]
    folded = submission.fold("sync", twin, run.calls[: max(picks) + 1])
    twins.states(folded)
    again = submission.call_each("sync", [(folded[i], *run.calls[i]) for i in picks])
    kit.expect_true(
        all(twins.same(value, folded[i + 1]) for value, i in zip(again, picks, strict=True)),
        "Given the same earlier twin and measurement again, sync returns a different twin.",
        help='Everything that sync remembers has to be in twin["memory"].',
        diagnose=twins.named("GLOBAL_MEMORY"),
    )
    driven = {**folded[in_time], "drive": folded[in_time]["drive"] + 0.2}
    for twin, i in ((folded[0], 0), (folded[in_time], in_time), (folded[late], late), (driven, in_time)):
        value = bundles.expect_clean(submission, "sync", (twin, *run.calls[i]), ("twin", None, None))
        twins.states([value])
        for key, units in (("drive", "m/s²"), ("sigma", "m")):
            kit.expect_close(
                kit.as_number(value[key], key),
                twin[key],
                abs=1e-9,
                source="it is not for sync to change",
                quantity=key,
                units=units,
                message=f"The {key} of the returned twin is not that of the twin that was passed in.",
                diagnose=twins.named("DRIVE_CHANGED"),
            )


def _expect_small_memory(submission, twin, calls):
    """Looked at after these measurements and after half of them; all that it held on the way is too much."""
    half = len(calls) // 2
    middle = _folded(submission, twin, calls[:half], keep=scenes.SEEN)[-1]
    last = _folded(submission, middle, calls[half:], keep=scenes.SEEN)[-1]
    held, before = (twins.numbers_in(each["memory"]) for each in (last, middle))
    for most, code, message in (
        (1.5 * before + 20, "MEMORY_GROWS", "The memory grows with the length of the run."),
        (MEMORY_WITHIN, "MEMORY_TOO_LARGE", "The memory holds more numbers than the README allows."),
    ):
        kit.expect_bounded(
            held,
            high=most,
            source="the README's",
            quantity="numbers in the memory after 16 s",
            input={"after 8 s": before},
            message=message,
            help="Keep the last second or two of the history, and discard what is older.",
            diagnose=twins.named(code),
        )


#: Numbers that the memory may hold.
MEMORY_WITHIN = 1000


# -- both directions closed into a loop: the cart rolls on this side, and only here is its friction known ----

#: Std of a position sensor better than the ordinary one, m: a loop's end is one draw of a noisy estimate.
QUIET = 0.006


def expect_sync_closes_loop(submission, rng):
    """A cart that is driven by what the twin has learned gets back to its speed after the friction jumped.

    Five seconds at a time are folded through the student's sync; then the drive is set anew, from the mean
    friction of three seconds, for one estimate is a noisy thing.
    """
    before, after = jump(rng)
    target = rng.uniform(0.7, 1.2) * rng.choice([-1.0, 1.0])
    cart = scenes.Cart(((0.0, before), (6.0, after)), v=0.4 * target)
    guess = before * rng.uniform(0.75, 1.33)
    twin = new_twin(guess, guess * target, speed=cart.v, sigma=QUIET)
    given = {"target": target, "frictions": [before, after], "first guess": guess}
    ask = lambda: _of_sync(submission, late=False, backwards=target < 0)  # noqa: E731
    speeds, friction = [], 0.0
    for i in range(5):
        start = 5.0 * i
        times = np.append(scenes.moments(rng, 4.95, start), start + 5.0)
        run = scenes.measured(cart, twin["drive"], times, rng, sigma=QUIET)
        folded = _folded(submission, twin, run.calls, keep=scenes.SEEN)
        if not i:
            _expect_no_foresight(submission, twin, run.calls, folded)
        rows = twins.path(folded)
        _expect_no_flight(rows[1:], given, ask)
        speeds = run.truth[run.truth[:, 0] > start + 3.0, 2]
        with np.errstate(all="ignore"):
            friction = float(np.mean(rows[1:][run.truth[:, 0] > start + 2.0, 3]))
        kit.expect_bounded(
            friction,
            low=0.05,
            high=10.0,
            source="every cart here is far inside",
            quantity="friction",
            units="1/s",
            input=given,
            message="The twin's friction is far from that of any cart here.",
            diagnose=ask,
        )
        twin = {**folded[-1], "drive": friction * target}
    kit.expect_close(
        float(np.mean(speeds)),
        target,
        rel=0.1,
        source="the README's",
        quantity="speed of the cart at the end",
        units="m/s",
        input=given,
        message="A cart whose drive comes from the twin's friction does not get back to its speed.",
        help="Its drive is the mean friction of the last 3 s times the target speed. Print the friction and "
        "the surprises after the jump: is each of them used, and does it bring the friction closer to the "
        "cart's? If the drive is kept from an earlier call, take that of the twin: it may change.",
        diagnose=ask,
    )
    kit.expect_close(
        friction,
        after,
        rel=0.1,
        source="the README's",
        quantity="friction",
        units="1/s",
        input=given,
        message="In the closed loop, the twin does not find the friction.",
        diagnose=ask,
    )


def expect_command_closes_loop(submission, rng):
    """Driven by command ten times a second, a cart whose friction jumps gets to its speed and back to it.

    Two carts, one forwards and one backwards. A twin of ours follows each by constant shares: all that
    ``command`` needs is a friction that is learned on the way.
    """
    step, n = 0.1, 150
    targets = rng.uniform(0.6, 1.2) * np.array([1.0, -1.0])
    frictions = [jump(rng) for _ in targets]
    carts = [
        scenes.Cart(((0.0, before), (5.0, after)), v=0.4 * target)
        for (before, after), target in zip(frictions, targets, strict=True)
    ]
    x, v, b = np.zeros(2), np.array([cart.v for cart in carts]), np.array([before for before, _ in frictions])
    drives, places, gains = np.zeros(2), np.zeros((n + 1, 2)), [0.0]
    ask = lambda: twins.of_command(submission)  # noqa: E731
    given = {"targets": targets, "frictions before and after 5 s": frictions}
    for k in range(n):
        now = [new_twin(*each, t=step * k) for each in zip(b, drives, strict=True)]
        calls = [
            ({**twin, "position": float(x[i]), "speed": float(v[i])}, float(targets[i]))
            for i, twin in enumerate(now)
        ]
        drives = np.array([kit.as_number(u, "the drive") for u in submission.call_each("command", calls)])
        kit.expect_bounded(
            float(np.max(np.abs(drives))),
            high=100.0,
            source="fifty times what these carts need",
            quantity="largest drive",
            units="m/s²",
            input={**given, "time": step * k, "speeds": v},
            message="`command` asks for a drive far beyond what any of these carts needs to hold its speed.",
            help="A correction must be zero at the target speed, push towards it on both sides, and be weak "
            "enough for a command every 0.1 s.",
            diagnose=ask,
        )
        far = np.abs(targets - v) > 0.1
        gains += ((drives - b * targets)[far] / (targets - v)[far]).tolist()
        a = drives - b * v
        x, v = x + step * v + step**2 / 2 * a, v + step * a
        for cart, drive in zip(carts, drives, strict=True):
            cart.roll(float(drive), step * (k + 1))
        places[k + 1] = [cart.x for cart in carts]
        surprise = places[k + 1] + QUIET * rng.standard_normal(2) - x
        x, v = x + 0.3 * surprise, v + 0.5 * surprise
        b = np.maximum(b - 0.4 * surprise * np.sign(v), 0.1)
    reached = (places[-1] - places[-31]) / (30 * step)
    kit.expect_array(
        reached / targets,
        np.ones(2),
        abs=0.08,
        source="the README's",
        quantity="speed over the last three seconds, as a share of the target",
        input={**given, "speeds": reached},
        message="Over the last three seconds, a cart that is driven by command is not at its target speed.",
        help="Compute the drive from the friction that the twin has learned and from the target speed; a "
        "correction must push towards that speed, forwards and backwards.",
        diagnose=ask,
    )
    asked = [(gain, given) for gain in (max(gains), min(gains))]
    # Beyond what a twin learns here: a correction by the friction itself may push away from the target there.
    slow = [(b, target, 0.5 * target) for b in (0.3, 2.0) for target in targets.tolist()]
    # Next to the target speed, on either side: there a correction is nearly zero, and its sign alone is not.
    slow += [(0.8, target, share * target) for share in (0.99, 1.01) for target in targets.tolist()]
    calls = [(scenes.new_twin(b, 0.0, speed=speed), target) for b, target, speed in slow]
    for (b, target, speed), drive in zip(slow, submission.call_each("command", calls), strict=True):
        gain = (kit.as_number(drive, "the drive") - b * target) / (target - speed)
        asked.append((gain, {"friction": b, "speed": speed, "target speed": target, "drive": drive}))
    for gain, case in asked:
        kit.expect_bounded(
            0.0 if abs(gain) < 1e-6 else gain,  # the rounding of a balance without a correction
            low=0.0,
            high=twins.LARGEST_GAIN,
            source="the README's, with room for rounding",
            quantity="what is added, over the difference of the speeds",
            units="1/s",
            input=case,
            message="What `command` adds to friction times target speed is none of the corrections allowed.",
            help="Add nothing, or the difference of the speeds times 0.2 to 3 per second.",
            diagnose=ask,
        )
