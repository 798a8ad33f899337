"""Mistakes in `push-never-pull`: words beside the programs that they are true of."""

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "CORRECTION_CUT_OFF",
    "Every negative correction is dropped, so an impulse that was too large can never be taken back.",
    "Limit the sum, not the correction: the sum may go down to zero.",
).edit("applied", {"total + wanted, 0.0) - total": "wanted, 0.0)"})
mistakes(
    "PULLS",
    "The sum can go below zero: the contact pulls.",
    "Where total + wanted is negative, apply only -total.",
).edit("applied", {"max(total + wanted, 0.0) - total": "wanted"})
mistakes(
    "SUM_NOT_CORRECTION",
    "Your result is the new sum, so the old one would be applied again.",
    "Subtract the impulse that was applied before: return only the change.",
).edit("applied", {") - total": ")"})
mistakes(
    "ALL_TAKEN_BACK",
    "Any negative correction takes the whole impulse back.",
    "Take back what is wanted, but no more than there is.",
).edit("applied", {"return max(total + wanted, 0.0) - total": "return wanted if wanted > 0 else -total"})
mistakes(
    "TAKES_WITH_A_PLUS",
    "Where the sum would go below zero you add the total once more.",
    "Take it back: apply -total.",
)
mistakes(
    "NOTHING_TAKEN",
    "Where the sum would go below zero you change nothing.",
    "Take back what there is: apply -total.",
)
mistakes(
    "SUM_BELOW_ZERO",
    "Where the sum would go below zero you give that sum.",
    "Take back what there is: apply -total.",
).edit("applied", {"max(total + wanted, 0.0) - total": "wanted if total + wanted >= 0 else total + wanted"})
mistakes(
    "ONLY_WHAT_IS_LEFT",
    "Your correction is never larger than the sum so far.",
    "A correction may add as much as it wants. Only total + wanted must not be below zero.",
).edit("applied", {"max(total + wanted, 0.0) - total": "min(total, wanted)"})
mistakes(
    "LARGER_OF_THE_TWO",
    "You give the larger of wanted and total.",
    "The least that can be applied is minus the total: that takes back all there is.",
).body("applied", "return max(wanted, total)")
mistakes(
    "NOTHING_FROM_ZERO",
    "Where no impulse was applied so far, you apply none.",
    "A first push is a correction too: apply what is wanted, unless the sum would go below zero.",
).edit("applied", {"return max(": "return 0.0 if total == 0 else max("})
mistakes(
    "SUM_WHERE_IT_FITS",
    "Where the sum stays above zero you give the new sum.",
    "Give the change: there all of wanted is applied.",
)
mistakes(
    "WANTED_TURNED",
    "Where the sum would go below zero you give -wanted.",
    "Take back what there is: apply -total.",
)

mistakes.accept(
    "The correction is at least minus the sum",
    """
        def applied(total, wanted):
            return max(wanted, -total)
    """,
)
mistakes.accept(
    "Two cases",
    """
        def applied(total, wanted):
            if total + wanted < 0:
                return -total
            return wanted
    """,
)


def correction(fits=lambda total, wanted: wanted, below=lambda total, wanted: -total):
    return lambda total, wanted: (below if total + wanted < 0 else fits)(total, wanted)


mistakes.terms(
    "applied",
    correction,
    {
        "fits": {"SUM_WHERE_IT_FITS": lambda total, wanted: total + wanted},
        "below": {
            "TAKES_WITH_A_PLUS": lambda total, wanted: total,
            "NOTHING_TAKEN": lambda total, wanted: 0.0,
            "WANTED_TURNED": lambda total, wanted: -wanted,
        },
    },
)


@mistakes.more
def only_what_is_left():
    yield "applied", ("ONLY_WHAT_IS_LEFT",), correction(fits=min)
