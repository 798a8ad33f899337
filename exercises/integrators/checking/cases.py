"""What public and hidden checks of ``integrators`` ask alike: drawn cases, and expectations."""

from __future__ import annotations

import math

import numpy as np

from course.physics.systems import FreeFall, LinearStep, Oscillator
from course.scoring import kit

probes = kit.companion("integrators", "probes")


def refused(rng):
    """(t_end, h), not a whole number of steps: off by much, by a thousandth of a short step, by 3e-6 steps.

    On both sides of a whole number, each kind.

    A difference in seconds, or one relative to the number of steps, would let the last two pass.
    """
    found = [((int(rng.integers(5, 30)) + side * rng.uniform(0.2, 0.45)) * 0.1, 0.1) for side in (1, -1)]
    for excess in (1e-3, 3e-6, -1e-3, -3e-6):
        h = float(rng.uniform(1e-4, 3e-4))
        found.append(((int(rng.integers(300, 500)) + excess) * h, h))
    return [(float(t_end), h) for t_end, h in found]


def scattered(rng):
    """(hs, errors) that do not all grow together; tiny, equal and falling errors; the same step twice."""
    hs = 0.3 * np.cumprod(rng.uniform(0.5, 0.8, 6))
    up_and_down = np.exp(rng.uniform(0.8, 1.6, 6) * np.array([-1, 1, -1, 1, -1, 1]))
    yield hs, rng.uniform(0.1, 10.0) * hs ** rng.uniform(0.8, 1.5) * up_and_down
    hs = 0.3 * np.cumprod(rng.uniform(0.08, 0.3, 5))
    errors = hs ** rng.uniform(3.0, 4.5) * np.exp(rng.normal(0.0, 0.3, 5))
    yield hs, errors * 10 ** rng.uniform(-17.0, -15.0) / errors.min()
    hs = 0.3 * np.cumprod(rng.uniform(0.4, 0.7, 5))
    errors = hs ** rng.uniform(0.8, 3.0) * np.exp(rng.normal(0.0, 0.2, 5))
    errors[2] = errors[1]
    yield hs, errors
    yield hs, errors[::-1] * np.array([1.0, 1.1, 0.9, 1.1, 1.0])
    yield hs[[0, 1, 2, 2, 3, 4]], np.append(errors, 0.7 * errors[4])
    yield hs, np.full(5, errors[0])


def starts(rng):
    """Where narrow unstable ranges begin, h omega: at so many places that a coarse search steps over one.

    The last four are side by side, where steps that grow with h are longest.
    """
    return *rng.uniform(0.6, 4.0, 8).tolist(), *(rng.uniform(7.5, 8.6) + WIDTH * np.arange(4)).tolist()


#: Of the narrow ranges, in h omega: the README promises 0.25.
WIDTH = 0.27


def pocket(low):
    """A map that is unstable in h omega from ``low`` to ``low`` + ``WIDTH`` and stable around it."""
    high = low + WIDTH
    curve = 1.5 / (low * high)
    return LinearStep([1 - curve * low * high, curve * (low + high), -curve], [0.0], [0.0], [0.2])


def slow_growth(limit):
    """A map that grows beyond h omega = ``limit``, by a ten millionth at 1 % beyond."""
    return LinearStep([1 - 1e-5, 1e-5 / limit], [0.0], [0.0], [0.2])


def turn(c, s, z=None):
    """A rotation that may shrink; with z, for the step h omega = z alone, so that h must be right."""
    powers = (lambda entry: [entry]) if z is None else (lambda entry: [0.0, entry / z])
    return LinearStep(powers(c), powers(s), powers(-s), powers(c))


# -- expectations ---------------------------------------------------------------------------------------


#: Exceptions that are raised to refuse something, and by no slip in the code.
_OTHER_REFUSALS = ("Exception", "RuntimeError", "AssertionError", "ArithmeticError")


def histories(value):
    """t, q and v of what integrate returns; if the times stand elsewhere, that is said."""
    parts = kit.as_tuple(value, ("t", "q", "v"))
    one_row = [kit.attempt(lambda part=part: kit.as_vector(part)) is not None for part in parts]
    tables = [kit.attempt(lambda part=part: kit.as_matrix(part, (None, None))) is not None for part in parts]
    if sum(one_row) == 1 and sum(tables) == 2 and not one_row[0]:
        kit.fail(
            "integrate returns its three results in another order.",
            expected="(t, q, v)",
            actual=f"the times are number {one_row.index(True) + 1} of three",
            help="Return (t, q, v): the times first, then the positions, then the velocities.",
            diagnose=probes.named("TIMES_NOT_FIRST"),
        )
    return parts


def expect_limit(submission, value, case, *, input, message):
    """max_stable_step is right to 1 %, and zero and infinity exactly. case: step, omega, limit * omega."""
    step, omega, limit = case
    if value is None:
        code = {0.0: "NONE_FOR_ZERO", math.inf: "NONE_FOR_INFINITY"}.get(limit, "NONE_FOR_LIMIT")
        told = {"expected": limit / omega, "actual": "None", "units": "s"}
        kit.fail(message, input=input, diagnose=probes.named(code), **told)
    kit.expect_close(
        value,
        limit / omega,
        rel=0.01,
        source="the README's 1 %",
        quantity="largest stable step",
        units="s",
        input=input,
        message=message,
        help="Walk up from 0.05/omega. At each step build the matrix on (q, v/omega) from two calls: no "
        "eigenvalue may have a modulus above 1 + 1e-8. Then bisect between the last stable step and the "
        "first unstable one.",
        diagnose=lambda: probes.of_stability(submission, value, step, omega, limit),
    )


def expect_refusals(submission, state, durations):
    """Each (t_end, h) raises ValueError."""
    for t_end, h in durations:
        try:
            kit.expect_raises(
                lambda t_end=t_end, h=h: submission.call(
                    "integrate", probes.IDENTITY, Oscillator(1.0), *state, t_end, h
                ),
                "ValueError",
                input={"t_end": t_end, "h": h},
                message="A duration that is not a whole number of steps is not refused.",
                diagnose=lambda: probes.of_acceptance(submission, *state),
            )
        except kit.StudentFailure as failure:
            if failure.type not in _OTHER_REFUSALS:
                raise
            kit.fail(
                "integrate refuses the duration with another exception than ValueError.",
                input={"t_end": t_end, "h": h},
                expected="ValueError",
                actual=failure.type,
                diagnose=probes.named("OTHER_EXCEPTION"),
            )


def expect_taken(submission, state, durations):
    """Each (t_end, h) is nearly enough a whole number of steps, and has as many rows and one."""
    for t_end, h in durations:
        value = kit.expect_accepts(
            lambda t_end=t_end, h=h: submission.call(
                "integrate", probes.IDENTITY, Oscillator(1.0), *state, t_end, h
            ),
            "ValueError",
            input={"t_end": t_end, "h": h},
            message="A duration that is less than 1e-6 of a step from a whole number of steps is refused.",
            diagnose=lambda: probes.named("REFUSES_NEARLY_WHOLE"),
        )
        kit.expect_length(
            histories(value)[0],
            round(t_end / h) + 1,
            message="integrate does not return N + 1 times for N steps.",
            help="N = round(t_end / h), for a duration that is a little less than N steps, too.",
            input={"t_end": t_end, "h": h},
        )


def expect_calls(submission, n=5, h=0.25):
    """The step is called once for each of n steps."""
    step = kit.counted(lambda accel, t, q, v, h: (np.asarray(q) + h, np.asarray(v)))
    submission.call("integrate", step, Oscillator(1.0), np.array([1.0]), np.array([0.5]), n * h, h)
    kit.expect_true(
        step.count == n,
        "integrate does not call the step once for each of the N steps.",
        input={"t_end": n * h, "h": h},
        expected=n,
        actual=step.count,
        diagnose=probes.named("STEPS_THROWN_AWAY" if step.count > n else "STEPS_LEFT_OUT"),
    )


def expect_start_kept(submission, args, inspected, given):
    """integrate leaves q0, v0 (whole in ``inspected``, then floats) and earlier results as they are."""
    step, accel, q0, v0, *rest = args
    floats = [step, accel, q0.astype(float), v0.astype(float), *rest]
    for asked, seen in ((args, inspected), (floats, submission.call_inspect("integrate", *floats))):
        kit.expect_untouched(
            asked,
            seen,
            names=["", "", "q0", "v0", "", ""],
            mutated=probes.named("MUTATES_INPUT"),
            shared=probes.named("RETURNS_ARGUMENT"),
            input=given,
        )
    submission.call_each("integrate", [floats, [step, accel, floats[3], floats[2], *rest]])


def expect_clean(submission, task, system, t, whole, h):
    """A step changes none of its arguments, returns arrays of its own and takes whole numbers (``whole``).

    It calls accel by position: an accel may have other names for its arguments.
    """
    whole = [np.array(part) for part in whole]
    args = [system, t, *(part.astype(float) for part in whole), h]
    given = {**system.params(), "t": t, "q": whole[0], "v": whole[1], "h": h}
    inspected = submission.call_inspect(task, *args)
    wanted = kit.as_pair(inspected.value, 2)
    _expect_by_position(submission, task)
    kit.expect_untouched(
        args,
        inspected,
        names=["", "", "q", "v", ""],
        mutated=probes.named("MUTATES_INPUT"),
        shared=probes.named("RETURNS_ARGUMENT"),
        input=given,
    )
    _expect_plain_motion(submission, task, args, given)
    _expect_sum(submission, task, args)
    _expect_the_same_again(submission, task, args, wanted, given)
    _expect_whole(submission, task, system, [t, *whole, h], wanted, given)
    between = [t, whole[0], whole[1] + 0.5, h]
    floats = kit.as_pair(submission.call(task, system, t, args[2], between[2], h), 2)
    _expect_whole(submission, task, system, between, floats, {**given, "v": between[2]})
    # An acceleration of whole numbers, too, must not leave the result without room for fractions.
    floats = kit.as_pair(submission.call(task, _spring, *args[1:]), 2)
    spring = {"accel": "-4 * q, of whole numbers", "t": t, "q": whole[0], "v": whole[1], "h": h}
    kit.expect_true(
        np.any(floats[1] != args[3]) or not whole[0].any(),
        "The acceleration makes no difference to the velocity.",
        input=spring,
    )
    _expect_whole(submission, task, _spring, [t, *whole, h], floats, spring)


def _expect_plain_motion(submission, task, args, given):
    """At rest, and without forces far away and fast, or near and slow: what is not changed is returned in an
    array of its own, too."""
    system, t, q, v, h = args
    moves = ((system, q, 0 * v), (FreeFall(0.0), 1e-7 * q, 1e-8 * v), (FreeFall(0.0), 1000.0 * q, 1000.0 * v))
    for accel, at, speed in moves:
        call = [accel, t, at, speed, h]
        told = {**given, **({} if accel is system else {"accel": "0"}), "q": at, "v": speed}
        inspected = submission.call_inspect(task, *call)
        kit.expect_untouched(
            call,
            inspected,
            names=["", "", "q", "v", ""],
            mutated=probes.named("MUTATES_INPUT"),
            shared=probes.named("RETURNS_ARGUMENT"),
            input=told,
        )
        if accel is system:
            continue
        for actual, expected, name in zip(
            kit.as_pair(inspected.value, 2), (at + h * speed, speed), ("q_next", "v_next"), strict=True
        ):
            kit.expect_array(
                actual,
                expected,
                rel=1e-12,
                source="uniform motion: only rounding is allowed",
                quantity=name,
                input=told,
                message="Without an acceleration, a step is not q + h v and v.",
                help="Compare both lines with the formula, for slow and fast bodies, near and far away: with "
                "an acceleration of zero it gives this.",
                diagnose=lambda: probes.of_step(submission, task),
            )


def _expect_sum(submission, task, args):
    """In free fall and on a spring a step is linear but for a constant: steps add up."""
    _, t, q, v, h = args
    for system, name in ((FreeFall(7.0), "free fall"), (Oscillator(1.7), "a spring")):
        states = ((q, 0 * v), (0 * q, v), (q, v), (0 * q, 0 * v))
        values = submission.call_each(task, [(system, t, *state, h) for state in states])
        # What is no number everywhere is told elsewhere.
        still, middle, *rest = (np.nan_to_num(kit.as_pair(value, 2)) for value in values)
        for actual, expected, part in zip(still + middle, sum(rest), ("q_next", "v_next"), strict=True):
            kit.expect_array(
                actual,
                expected,
                rel=1e-12,
                abs=1e-12,
                source="linear but for a constant: only rounding is allowed",
                quantity=f"{part}, summed",
                input={"accel": name, **system.params(), "t": t, "q": q, "v": v, "h": h},
                message="The steps from (q, 0) and (0, v) do not add up to those from (q, v) and (0, 0).",
                help="The same formulas hold for every state: at rest, without a pull, and at any speed.",
                diagnose=lambda: probes.of_step(submission, task) or probes.of_zeros(submission, task),
            )


def _expect_the_same_again(submission, task, args, end, given):
    """A step gives the same again after others that have something in common with it; none is overwritten.

    end: position and velocity after it.
    """
    system, t, q, v, h = args
    others = (
        [system, t - h, v, q, h],  # ends where it begins, elsewhere
        [system, t, v, v, h],
        [system, t, q, q, h],
        [system, t, q, v, 2 * h],
        [Oscillator(1.3), t, q, v, h],
    )
    # It begins where that step ends, under another acceleration.
    onward = [Oscillator(1.3), t + h, *end, h]
    for call, between in ((onward, [args]), (args, others)):
        values = submission.call_each(task, [call, *(one for other in between for one in (other, call))])
        # What is no number each time is the same each time.
        first, *again = [np.nan_to_num(np.concatenate(kit.as_pair(value, 2))) for value in values[::2]]
        told = given if call is args else {"accel": "a spring", "t": t + h, "q": end[0], "v": end[1], "h": h}
        for result in again:
            kit.expect_array(
                result,
                first,
                rel=1e-9,
                source="rounding; a result may lie elsewhere in memory",
                quantity="q_next and v_next",
                input=told,
                message="The same step, asked for again after another one, has another result.",
                diagnose=lambda: probes.named("STALE_CACHE"),
            )


def _spring(t, q, v):
    """-4 q, of the type that q has."""
    return -4 * np.asarray(q)


def _expect_whole(submission, task, accel, call, wanted, given):
    """From whole numbers a step gives what it gives from floats (``wanted``)."""
    result = kit.expect_accepts(
        lambda: submission.call(task, accel, *call),
        "TypeError",
        input=given,
        message="The step fails on a state of whole numbers.",
        diagnose=lambda: probes.of_whole_numbers(submission, task),
    )
    for actual, expected, name in zip(kit.as_pair(result, 2), wanted, ("q_next", "v_next"), strict=True):
        kit.expect_array(
            actual,
            expected,
            rel=1e-12,
            source="the same step from the same state as floats",
            quantity=name,
            input=given,
            message="From a state of whole numbers the step gives a different result than from the same "
            "state as floats.",
            diagnose=lambda: probes.of_whole_numbers(submission, task),
        )


def _expect_by_position(submission, task):
    """accel is called by position, as ``accel(t, q, v)``: its own names for them may be others."""
    by_name = set()

    def accel(*args, **names):
        by_name.update(names)
        return np.zeros(2)

    kit.attempt(
        lambda: submission.call(
            task, kit.counted(accel), 0.6, np.array([0.7, -0.4]), np.array([0.3, 1.1]), 0.31
        )
    )
    kit.expect_true(
        not by_name,
        "The step calls accel with arguments by name.",
        diagnose=probes.named("ACCEL_BY_KEYWORD"),
    )
