"""Mistakes in `too-far-apart`: words beside the programs that they are true of."""

import math

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "DOUBTS_ADDED",
    "The uncertainties are added, which makes every difference look smaller than it is.",
    "Add their squares and take the root.",
).edit("distance_in_doubts", {"math.hypot(doubt_s,": "(doubt_s +"})
mistakes(
    "SIGN_KEPT",
    "A simulation below the measurement gives a negative number, which is below 2 however far apart they are.",
    "Take the size of the difference.",
).edit("distance_in_doubts", {"return abs(simulated": "return (simulated"})
mistakes(
    "SIMULATION_WITHOUT_DOUBT",
    "Only the measurement's uncertainty counts.",
    "A simulation has an uncertainty too: combine both.",
).edit("distance_in_doubts", {"math.hypot(doubt_s, doubt_m)": "doubt_m"})
mistakes(
    "ROOT_MISSING",
    "You divide by the variance.",
    "Take the root of the sum of the squares.",
).edit("distance_in_doubts", {"math.hypot(doubt_s, doubt_m": "(doubt_s**2 + doubt_m**2"})
mistakes(
    "MEAN_OF_THE_SQUARES",
    "You took the root of the mean of the squares: the uncertainty of one of the two, not of their difference.",
    "Add the squares without halving, and take the root.",
).edit("distance_in_doubts", {"math.hypot(doubt_s, doubt_m)": "math.sqrt((doubt_s**2 + doubt_m**2) / 2)"})
mistakes(
    "MEASUREMENT_WITHOUT_DOUBT",
    "Only the simulation's uncertainty counts.",
    "A measurement has an uncertainty too: combine both.",
).edit("distance_in_doubts", {"math.hypot(doubt_s, doubt_m)": "doubt_s"})
mistakes(
    "LARGER_DOUBT",
    "Only the larger uncertainty counts.",
    "Both count: add their squares and take the root.",
).edit("distance_in_doubts", {"math.hypot(doubt_s, doubt_m)": "max(doubt_s, doubt_m)"})
mistakes(
    "MEAN_OF_THE_DOUBTS",
    "You divide by the mean of the uncertainties.",
    "The uncertainty of a difference is larger than either: add the squares and take the root.",
).edit("distance_in_doubts", {"math.hypot(doubt_s, doubt_m)": "((doubt_s + doubt_m) / 2)"})
mistakes(
    "HALF_NOT_ROOT",
    "You took the sum of the squares without its root, and divided by 2.",
    "Write **0.5, or math.sqrt. Python reads x**1/2 as half of x. And put brackets round what you divide by.",
).edit("distance_in_doubts", {"math.hypot(doubt_s, doubt_m)": "(doubt_s**2 + doubt_m**2) / 2"})
mistakes(
    "NOT_SQUARED",
    "You took the root of the sum, but the uncertainties are not squared.",
    "Square each, add, then take the root.",
).edit("distance_in_doubts", {"math.hypot(doubt_s, doubt_m)": "math.sqrt(doubt_s + doubt_m)"})
mistakes(
    "DOUBTS_MULTIPLIED",
    "You divide by the root of the product of the uncertainties.",
    "Add their squares and take the root.",
).edit("distance_in_doubts", {"math.hypot(doubt_s, doubt_m)": "math.sqrt(doubt_s * doubt_m)"})
mistakes(
    "SQUARES_SUBTRACTED",
    "You subtract the squares of the uncertainties.",
    "The uncertainty of a difference is larger than either: add the squares and take the root.",
).edit("distance_in_doubts", {"math.hypot(doubt_s, doubt_m)": "math.sqrt(abs(doubt_s**2 - doubt_m**2))"})
mistakes(
    "ARGUMENTS_EXCHANGED",
    "You took the arguments in another order.",
    "Their order is: simulated, doubt_s, measured, doubt_m.",
).edit(
    "distance_in_doubts",
    {"simulated - measured": "simulated - doubt_s", "math.hypot(doubt_s, ": "math.hypot(measured, "},
)
mistakes(
    "SIZES_SUBTRACTED",
    "You take the sizes of the two results before you subtract.",
    "Subtract them with their signs, and take the size of the difference.",
).edit("distance_in_doubts", {"simulated - measured": "abs(simulated) - abs(measured)"})

mistakes.accept(
    "The root of a quotient",
    """
        def distance_in_doubts(simulated, doubt_s, measured, doubt_m):
            return ((simulated - measured) ** 2 / (doubt_s**2 + doubt_m**2)) ** 0.5
    """,
)
mistakes.accept(
    "By the variances",
    """
        def distance_in_doubts(simulated, doubt_s, measured, doubt_m):
            variance = doubt_s**2 + doubt_m**2
            return abs(measured - simulated) / math.sqrt(variance)
    """,
)


def distance(doubt=math.hypot, size=abs):
    return lambda simulated, doubt_s, measured, doubt_m: size(simulated - measured) / doubt(doubt_s, doubt_m)


mistakes.terms(
    "distance_in_doubts",
    distance,
    {
        "doubt": {
            "DOUBTS_ADDED": lambda s, m: s + m,
            "ROOT_MISSING": lambda s, m: s * s + m * m,
            "SIMULATION_WITHOUT_DOUBT": lambda s, m: m,
            "MEASUREMENT_WITHOUT_DOUBT": lambda s, m: s,
            "LARGER_DOUBT": max,
            "MEAN_OF_THE_SQUARES": lambda s, m: math.hypot(s, m) / math.sqrt(2),
        },
        "size": {"SIGN_KEPT": lambda d: d},
    },
)
