"""Executing a submission's parts one after the other, with sound stand-ins for those that do not hold.

What a submission answered is kept as long as it is graded, so that no check asks for it twice.
"""

from __future__ import annotations

import weakref

import numpy as np

from course.scoring import kit

cart = kit.companion("sim-to-real", "cart")
words = kit.companion("sim-to-real", "words")
probes = kit.companion("sim-to-real", "probes")
judge = kit.companion("sim-to-real", "judge")
reference = kit.sibling(__file__, "reference")

_KEPT = weakref.WeakKeyDictionary()


def _kept(submission, name, make):
    """What ``make()`` gave, or raised, the first time: a function that hangs is waited for once only."""
    store = _KEPT.setdefault(submission, {})
    if name not in store:
        try:
            store[name] = make(), None
        except (kit.StudentFailure, kit.CheckFailed) as failure:
            store[name] = None, failure
    value, failure = store[name]
    if failure is not None:
        raise failure
    return value


def plan(submission):
    """What ``plan`` returns.

    Raises:
        StudentFailure: nothing.
    """
    return _kept(submission, "plan", lambda: submission.call("plan"))


def command(submission):
    """The submission's own excitation for twenty seconds, shape (2000,), N.

    Raises:
        CheckFailed: it is none.
        StudentFailure: there is none.
    """

    def make():
        rng = np.random.default_rng([submission.seed, 6])
        value = submission.call("design_excitation", cart.BUDGET_S, cart.U_BENCH, rng)
        return probes.command_of(value, cart.BUDGET_S, cart.U_BENCH)

    return _kept(submission, "command", make)


def bench(submission):
    """What identify says about two recordings of each reality, and the carts they are of.

    The recordings are made with the bench's own excitation. Three more, with the submission's, are put in
    the same round trip for ``estimates``.

    Raises:
        CheckFailed, StudentFailure: identify gave no estimate.
    """
    carts = [*reference.realities(submission.seed)] * 2
    values = _answers(submission)
    return [probes.estimate_of(value) for value in values[: len(carts)]], carts


def weak(submission):
    """What identify says about a short and weak recording of each reality.

    Raises:
        CheckFailed, StudentFailure: identify gave no estimate.
    """
    recordings = reference.weak_recordings(submission.seed)
    call = lambda: submission.call_each("identify", recordings)  # noqa: E731
    values = _kept(submission, "weak", lambda: probes.patient(call, "IDENTIFY_TOO_SLOW"))
    return [probes.estimate_of(value) for value in values]


def means(estimates):
    """Per reality the mean of what was said about its two recordings: chance weighs less than in one."""
    half = len(estimates) // 2
    return [
        {k: tuple(np.mean([first[k], second[k]], axis=0).tolist()) for k in first}
        for first, second in zip(estimates[:half], estimates[half:], strict=True)
    ]


def _answers(submission):
    carts = [*reference.realities(submission.seed)] * 2
    return _kept(submission, "bench", lambda: _identified(submission, carts))


def _identified(submission, carts):
    recordings = list(reference.recordings(submission.seed))
    own = kit.attempt(lambda: command(submission))
    if own is not None and judge.shown(own, carts[:3]):
        rng = np.random.default_rng([submission.seed, 7])
        recordings += [_recording(each, own, rng) for each in carts[:3]]
    try:
        return probes.patient(lambda: submission.call_each("identify", recordings), "IDENTIFY_TOO_SLOW")
    except kit.StudentFailure:
        if len(recordings) == len(carts):
            raise
        # Only the submission's own excitation may be at fault, and that is another task.
        alone = recordings[: len(carts)]
        return probes.patient(lambda: submission.call_each("identify", alone), "IDENTIFY_TOO_SLOW")


def _recording(reality, u, rng):
    t, y = cart.record(reality, u, rng)
    return t, u, y


def estimates(submission):
    """For each reality what tune is handed: the submission's own excitation and identification of it.

    Where these are missing or further off than the README allows, what an ordinary measurement would say.
    """
    carts = reference.realities(submission.seed)
    values = kit.attempt(lambda: _answers(submission)) or []
    found = [kit.attempt(lambda value=value: probes.estimate_of(value)) for value in values[2 * len(carts) :]]
    found += [None] * (len(carts) - len(found))
    return [
        {k: list(v) for k, v in own.items()} if own and _sound(own, reality) else cart.with_intervals(reality)
        for own, reality in zip(found, carts, strict=True)
    ]


def _sound(estimate, reality):
    """Whether every value (tau and latency too, which tune needs) is near enough for tuning to be fair."""
    off = {k: abs(estimate[k][0] / reality[k] - 1) for k in cart.NAMES}
    return all(off[k] <= limit for k, limit in _FAIR.items())


#: As a share. An estimate this far off costs 0.01 of success; beyond it the tuning would pay for it.
_FAIR = {"m": 0.02, "b": 0.10, "Fc": 0.10, "tau": 0.10, "latency": 0.08}


def box(submission):
    """The plan's own box if it fits the fleet and sound tuning does well with it, else the fleet's."""

    def make():
        own = words.box_of(plan(submission))
        fits = all(words.inside(k, *own[k]) >= 0.95 and words.width(k, *own[k]) <= 1.5 for k in cart.NAMES)
        sound = fits and reference.box_success(submission.seed, own) >= 0.97
        return {k: list(ends) for k, ends in own.items()} if sound else None

    return _kept(submission, "box", lambda: kit.attempt(make)) or cart.MATCHED
