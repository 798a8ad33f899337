"""What all checks of ``digital-twin`` have in common: one call that leaves its arguments alone."""

from __future__ import annotations

from course.scoring import kit

twins = kit.companion("digital-twin", "twin_probes")

CALIBRATED = "200 seeds of every correct solution, tests/benchmarks/calibration/digital-twin.md"


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
