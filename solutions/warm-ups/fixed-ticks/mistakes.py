"""Mistakes in `fixed-ticks`: words beside the programs that they are true of."""

import math

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "REST_FORGOTTEN",
    "The time left over from the frame before does not count.",
    "Start from frame + left.",
).around("ticks", "return _right(frame, h, 0.0)")
mistakes(
    "REST_THROWN_AWAY",
    "The account is left empty, so the simulation's clock falls behind.",
    "Return the time that the steps did not use: account minus steps times h.",
).body("ticks", "return int((frame + left) // h), 0.0")
mistakes(
    "ROUNDED",
    "The number of steps is rounded to the nearest, so a step may be taken before its time is there.",
    "A step needs a whole h in the account: round down.",
).edit("ticks", {"steps = int(account // h)": "steps = round(account / h)"})
mistakes(
    "ROUNDED_UP",
    "The number of steps is rounded up, so a step is taken before its time is there.",
    "A step needs a whole h in the account: round down.",
)
mistakes(
    "OLD_REST_KEPT",
    "The time that is left stays what it was before the frame.",
    "Return the time that the steps did not use: account minus steps times h.",
)
mistakes(
    "REST_OF_THE_FRAME",
    "The time left is what remains of this frame alone, without what was left over from the frame before.",
    "Return what remains in the account: account minus steps times h.",
).edit("ticks", {"account - steps * h": "frame % h"})
mistakes(
    "STEPS_OF_THE_FRAME",
    "The steps are counted from the frame alone, so what was left over is never used up.",
    "First add the frame to the account, then see how often h fits.",
).edit("ticks", {"int(account // h)": "int(frame // h)"})
mistakes(
    "ONE_STEP_AT_MOST",
    "You take one step at most in a frame.",
    "A long frame pays for several: take h out as often as it fits.",
).edit("ticks", {"int(account // h)": "1 if account >= h else 0"})
mistakes(
    "REST_SUBTRACTED",
    "The time left over is taken out of the account.",
    "It belongs to the simulation: add it to the frame.",
).edit("ticks", {"frame + left": "frame - left"})
mistakes(
    "REST_IN_STEPS",
    "The time left is in steps, not in seconds.",
    "A part of a step times h is a time.",
).edit("ticks", {"account - steps * h": "account / h - steps"})
mistakes(
    "EXACTLY_ONE_REFUSED",
    "An account of exactly h makes no step.",
    "A whole h is enough: compare with >=.",
).body(
    "ticks",
    """
        account, steps = frame + left, 0
        while account > h:
            account -= h
            steps += 1
        return steps, account
    """,
)
mistakes(
    "AT_LEAST_ONE_STEP",
    "You take at least one step in each frame, even if its time is not there.",
    "A short frame may have no step: its time stays in the account.",
).edit("ticks", {"int(account // h)": "max(1, int(account // h))"})
mistakes(
    "REST_ADDED_LATER",
    "The time left can be longer than a step: you add what was left to what remains of this frame.",
    "One more step may fit then. Return what remains in the account: account minus steps times h.",
).edit("ticks", {"account - steps * h": "left + frame % h"})

mistakes.accept(
    "Divides with remainder and returns a list",
    """
        def ticks(frame, h, left):
            steps, rest = divmod(frame + left, h)
            return [int(steps), rest]
    """,
)
mistakes.accept(
    "Takes the steps out one at a time",
    """
        def ticks(frame, h, left):
            account, steps = frame + left, 0
            while account >= h:
                account -= h
                steps += 1
            return steps, account
    """,
)


def ticks_of(
    account=lambda frame, left: frame + left, whole=math.floor, rest=lambda a, n, h, left: a - n * h
):
    def ticks(frame, h, left):
        time = account(frame, left)
        steps = whole(time / h)
        return steps, rest(time, steps, h, left)

    return ticks


mistakes.terms(
    "ticks",
    ticks_of,
    {
        "account": {"REST_FORGOTTEN": lambda frame, left: frame},
        "whole": {"ROUNDED": round, "ROUNDED_UP": math.ceil},
        "rest": {"REST_THROWN_AWAY": lambda *_: 0.0, "OLD_REST_KEPT": lambda a, n, h, left: left},
    },
)


@mistakes.more
def at_least_one():
    def ticks(frame, h, left):
        account = frame + left
        steps = max(1, int(account // h))
        return steps, max(0.0, account - steps * h)

    yield "ticks", ("AT_LEAST_ONE_STEP",), ticks
