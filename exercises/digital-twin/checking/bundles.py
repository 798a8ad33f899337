"""What all checks of ``digital-twin`` have in common: one call that leaves its arguments alone."""

from __future__ import annotations

from course.scoring import kit

twins = kit.companion("digital-twin", "twin_probes")


def unless(refuted, ask, other=lambda: None):
    """What a probe says of a check; where these numbers cannot come of that, what else is wrong.

    refuted: codes of mistakes that make no difference to the numbers of this check
    other: a probe that looks past them
    """
    said = ask()
    if said is None or said.code not in refuted:
        return said
    return twins.second_mistake(kit.attempt(other))


def one_by_one(first, second):
    """The call ``first``, then it with each argument of ``second`` in turn, so that none can be forgotten."""
    return [first, *((*first[:i], other, *first[i + 1 :]) for i, other in enumerate(second))]


def expect_clean(submission, task, args, names):
    """One call leaves its arguments alone and returns nothing that is theirs; its value."""
    inspected = submission.call_inspect(task, *args)
    for name, before, after in zip(names, args, inspected.args_after, strict=True):
        if name and not twins.same(before, after):
            kit.fail(
                f"The call changed its argument `{name}` in place.",
                diagnose=twins.named("MUTATES_INPUT"),
                expected={name: before},
                actual={name: after},
            )
    if inspected.shared:
        kit.fail(
            "What the call returned is the caller's own array or a part of it, not a new one.",
            diagnose=twins.named("RETURNS_ARGUMENT"),
        )
    return inspected.value
