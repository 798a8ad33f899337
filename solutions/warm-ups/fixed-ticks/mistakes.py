"""Mistakes in `fixed-ticks`: words beside the programs that they are true of."""

import math

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "REST_FORGOTTEN",
    "The time left over from the frame before does not count.",
    "Start from frame + left.",
).body(
    "ticks",
    """
        steps = int(frame // h)
        return steps, frame - steps * h
    """,
)
mistakes(
    "REST_THROWN_AWAY",
    "The account is left empty, so the simulation's clock falls behind.",
    "Return the time that the steps did not use: account minus steps times h.",
).body(
    "ticks",
    """
        return int((frame + left) // h), 0.0
    """,
)
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
