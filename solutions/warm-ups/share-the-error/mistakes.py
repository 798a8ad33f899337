"""Mistakes in `share-the-error`: words beside the programs that they are true of."""

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "AWAY_FROM_THE_SENSOR",
    "The difference is predicted minus measured, so the correction has the wrong sign.",
    "Add the share of measured minus predicted.",
).edit("corrected", {"predicted + share": "predicted - share"})
mistakes(
    "SHARES_SWAPPED",
    "The shares are swapped: with the share 0 it takes the measurement.",
    "The share says how far to go towards the measurement.",
).body("corrected", "return share * predicted + (1.0 - share) * measured")
mistakes(
    "MEASUREMENT_ADDED",
    "A share of the measurement is added, not of the difference.",
    "If both agree, there is nothing to correct: use measured minus predicted.",
).edit("corrected", {"(measured - predicted)": "measured"})
mistakes(
    "SHARE_IGNORED",
    "Your result is the middle, whatever the share is.",
    "Go only the given share of the way.",
).edit("corrected", {"predicted + share * (measured - predicted)": "(predicted + measured) / 2.0"})
mistakes(
    "CORRECTION_ALONE",
    "Your result is the correction alone.",
    "Add it to the prediction.",
)
mistakes(
    "FROM_THE_MEASUREMENT",
    "The correction is added to the measurement.",
    "It starts from the prediction.",
)
mistakes(
    "SIZE_OF_THE_DIFFERENCE",
    "You took the difference without its sign, so the correction always goes up.",
    "Leave out the abs: where the measurement is smaller the position must go down.",
).edit("corrected", {"(measured - predicted)": "abs(measured - predicted)"})
mistakes(
    "BOTH_IN_FULL",
    "You added the whole difference: your result is the measurement.",
    "Go only the given share of the way.",
).edit("corrected", {"share * (measured - predicted)": "(measured - predicted)"})
mistakes(
    "BRACKETS_MISSING",
    "Only the measurement is multiplied by the share, and then the prediction is subtracted in full.",
    "Put brackets round measured - predicted.",
).edit("corrected", {"(measured - predicted)": "measured - predicted"})
mistakes(
    "SAME_SHARE_OF_BOTH",
    "You take the same share of the prediction and of the measurement.",
    "If the measurement has a share, the prediction has what is left of 1.",
).edit("corrected", {"predicted + share * (measured - predicted)": "share * predicted + share * measured"})
mistakes(
    "ZERO_NOT_TAKEN",
    "You do not take a share of 0 as it is given.",
    "Python takes 0 for false in `or` and in `if share`. With the share 0 the prediction must come out.",
).edit("corrected", {"+ share *": "+ (share or 0.5) *"})
mistakes(
    "DIVIDED_BY_THE_WEIGHTS",
    "You give the prediction the weight 1 and the measurement the share, and divide by both.",
    "The weights are 1 - share and share, which are 1 together.",
).body("corrected", "return (predicted + share * measured) / (1.0 + share)")
mistakes(
    "CORRECTION_LIMITED",
    "A large correction is cut off.",
    "Go the given share of the way, however long it is.",
).edit("corrected", {"share * (measured - predicted)": "max(-0.1, min(0.1, share * (measured - predicted)))"})

mistakes.accept(
    "Starts from the other end",
    """
        def corrected(predicted, measured, share):
            return measured - (1.0 - share) * (measured - predicted)
    """,
)
mistakes.accept(
    "A mean with two weights",
    """
        def corrected(predicted, measured, share):
            return (1.0 - share) * predicted + share * measured
    """,
)


def corrected_by(start=lambda p, m: p, way=lambda p, m: m - p, share=lambda s: s):
    return lambda predicted, measured, s: start(predicted, measured) + share(s) * way(predicted, measured)


mistakes.terms(
    "corrected",
    corrected_by,
    {
        "start": {"CORRECTION_ALONE": lambda p, m: 0.0, "FROM_THE_MEASUREMENT": lambda p, m: m},
        "way": {"AWAY_FROM_THE_SENSOR": lambda p, m: p - m, "MEASUREMENT_ADDED": lambda p, m: m},
        "share": {"SHARES_SWAPPED": lambda s: 1 - s},
    },
)
