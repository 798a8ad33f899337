"""What the hidden graders of ``integrators`` expect of ``integrate``."""

from __future__ import annotations

import math

import numpy as np

from course.physics import systems
from course.scoring import kit

probes = kit.companion("integrators", "probes")
bundles = kit.sibling(__file__, "bundles")


def expect_times(submission, rng):
    """Each step is told when it starts: the path of a step that moves by ``drift * h * t`` tells."""
    n, drift, h, t_end = 0, rng.uniform(1.0, 3.0), 1.0, 1.0
    # Not here a duration that a quotient cut off would shorten: that has a check of its own.
    while int(t_end / h) != n:
        n = int(rng.integers(120, 200))
        # Five decimals, none a zero at the end.
        h = int(100 * rng.integers(20, 300) + 11 * rng.integers(1, 10)) / 100_000
        t_end = round(n * h, 5)
    q0, v0 = bundles.signed(rng, 0.5, 1.5), bundles.signed(rng, 0.5, 1.5)
    clock = systems.LinearStep([1.0], [0.0], [0.0], [1.0], clock=drift)
    given = {"t_end": t_end, "h": h, "q0": q0, "v0": v0, "step": "q + drift*h*t", "drift": drift}
    t, q, _ = _path(submission, [clock, systems.Oscillator(1.7), q0, v0, t_end, h], n, given)
    with np.errstate(all="ignore"):
        told = np.diff(q[:, 0]) / (drift * h)
    kit.expect_array(
        told,
        h * np.arange(n),
        abs=1e-6,
        source="the contract's 1e-9, and rounding where the times are read off the path",
        units="s",
        quantity="start of the step, as your path shows it",
        input=given,
        message="The path of a step that depends on its time is wrong.",
        help="Step number i starts at i * h.",
        diagnose=lambda: probes.of_times(submission, told, h),
    )
    kit.expect_array(
        t,
        h * np.arange(n + 1),
        abs=1e-9,
        source="the contract's 1e-9, which a running sum of h still meets",
        units="s",
        quantity="t",
        input=given,
        message="The times that integrate returns are not 0, h, 2h, ... up to t_end.",
        help="The time of sample i is i * h.",
    )


def expect_awkward_durations(submission, rng):
    """Durations whose quotient t_end / h misses a whole number by a rounding error are integrated."""
    state = bundles.signed(rng, 0.5, 1.5), bundles.signed(rng, 0.5, 1.5)
    for n, h in _awkward(rng):
        t_end = round(n * h, 3)
        _path(
            submission,
            [probes.IDENTITY, systems.Oscillator(1.0), *state, t_end, h],
            n,
            {"t_end": t_end, "h": h},
        )
        bundles.cases.expect_taken(submission, state, [(t_end + 4e-7 * h, h), (t_end - 4e-7 * h, h)])


def _awkward(rng):
    """Three (n, h) whose decimal t_end / h misses n in floating point, twice from below."""
    found = []
    while len(found) < 3:
        n, h = int(rng.integers(5, 60)), int(rng.integers(7, 400)) / 1000
        quotient = round(n * h, 3) / h
        if quotient < n if len(found) < 2 else quotient > n:
            found.append((n, h))
    return found


def expect_refusals(submission, rng):
    """Durations that end between two samples are refused, however short the steps and however many."""
    state = bundles.signed(rng, 0.5, 1.5), bundles.signed(rng, 0.5, 1.5)
    bundles.cases.expect_refusals(submission, state, bundles.cases.refused(rng))


def expect_whole_numbers(submission, rng):
    """An initial state of integers leads through fractions, and is still there afterwards."""
    n, h, omega, angle = 12, 0.125, 2.0, rng.uniform(0.3, 0.6)
    turn = bundles.cases.turn(math.cos(angle), math.sin(angle), h * omega)
    q0, v0 = rng.integers(1, 5, 3), rng.integers(-5, 5, 3)
    args = [turn, systems.Oscillator(omega), q0, v0, n * h, h]
    given = {"q0": q0, "v0": v0, "t_end": n * h, "h": h, "step": "a rotation", "angle": angle}
    inspected = kit.expect_accepts(
        lambda: submission.call_inspect("integrate", *args),
        "TypeError",
        input=given,
        message="integrate fails on an initial state of whole numbers.",
        diagnose=lambda: probes.of_whole_start(submission, args),
    )
    t, q, v = _arrays(submission, inspected.value, n, args, given)
    angles = angle * np.arange(n + 1)[:, None]
    q_true = np.cos(angles) * q0 + np.sin(angles) * v0 / omega
    v_true = np.cos(angles) * v0 - omega * np.sin(angles) * q0
    for actual, expected, name in ((q, q_true, "q"), (v, v_true, "v")):
        kit.expect_array(
            actual,
            expected,
            abs=1e-9,
            source="rounding",
            quantity=name,
            t=h * np.arange(n + 1),
            input=given,
            message="From an initial state of whole numbers, integrate does not return the states that "
            "the steps produce.",
            diagnose=lambda: probes.of_rows(t, q, v, h, (q_true, v_true)),
        )
    bundles.cases.expect_start_kept(submission, args, inspected, given)
    bundles.cases.expect_calls(submission, int(rng.integers(5, 12)))


def _path(submission, args, n, given):
    """t, q and v of a duration of n steps, which must not be refused."""
    value = kit.expect_accepts(
        lambda: submission.call("integrate", *args),
        "ValueError",
        input=given,
        message="integrate raises ValueError for a duration that is a whole number of steps.",
        diagnose=lambda: probes.of_refusal(submission, args[2], args[3], args[4]),
    )
    return _arrays(submission, value, n, args, given)


def _arrays(submission, value, n, args, given):
    """The three arrays that integrate returns, with a row for every sample."""
    d = len(args[2])
    t, q, v = bundles.cases.histories(value)
    for rows, name in ((t, "t"), (q, "q"), (v, "v")):
        kit.expect_length(
            rows,
            n + 1,
            name=name,
            input=given,
            message="An array that integrate returns does not have N + 1 rows, with N = round(t_end / h).",
            help="Take N = round(t_end / h) steps. Row 0 is the initial state, and each step adds a row.",
            diagnose=lambda name=name: probes.of_count(submission, n, args[5], q) if name == "t" else None,
        )
    return kit.as_array(t, (n + 1,), "t"), kit.as_array(q, (n + 1, d), "q"), kit.as_array(v, (n + 1, d), "v")
