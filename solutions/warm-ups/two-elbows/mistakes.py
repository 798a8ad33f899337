"""Mistakes in `two-elbows`: words beside the programs that they are true of."""

import math

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "ROD_ALONG_THE_RAIL",
    "Your places are one rod length to either side, as if the rod lay on the rail.",
    "The rod is the long side of a right triangle. Find the side along the rail.",
).edit("carriages", {"math.sqrt(length**2 - y**2)": "length"})
mistakes(
    "SQUARES_ADDED",
    "You added the squares of the rod and of the height.",
    "The rod is the longest side of the triangle, so subtract.",
).edit("carriages", {"**2 - y**": "**2 + y**"})
mistakes(
    "NO_ROOT",
    "The square root is missing.",
    "What you have is the square of the distance along the rail.",
).edit("carriages", {"math.sqrt(length**2 - y**2)": "length**2 - y**2"})
mistakes(
    "LENGTHS_SUBTRACTED",
    "You subtracted the height from the length.",
    "In a right triangle the squares are subtracted, not the lengths.",
).edit("carriages", {"math.sqrt(length**2 - y**2": "length - abs(y"})
mistakes(
    "LARGER_FIRST",
    "The larger place comes first.",
    "Give the smaller one first.",
).edit("carriages", {"- aside, x +": "+ aside, x -"})
mistakes(
    "X_FORGOTTEN",
    "Your places are measured from the foot of the point, not along the rail.",
    "Add x to both.",
).edit("carriages", {"x - aside, x +": "-aside,"})
mistakes(
    "ONE_PLACE_TWICE",
    "You found one of the places and gave it twice.",
    "The carriage can stand on either side of the point.",
).edit("carriages", {"x + aside": "x - aside"})
mistakes(
    "UPRIGHT_REFUSED",
    "You give None where the rod stands upright.",
    "A rod that is exactly as long as the point is high reaches it.",
).edit("carriages", {"if abs(y) > length:": "if abs(y) >= length:"})
mistakes(
    "ABOVE_ONLY",
    "You find a place for points that are too far below the rail.",
    "Compare the distance from the rail, which is |y|, with the length.",
).edit("carriages", {"if abs(y) > length:": "if y > length:", "length**2 - y**2": "abs(length**2 - y**2)"})
mistakes(
    "ALWAYS_A_PLACE",
    "You find a place for points that are out of reach.",
    "If the point is farther from the rail than the rod is long, give None.",
).edit(
    "carriages",
    {"    if abs(y) > length:\n        return None\n": "", "(length**2 - y**2)": "(abs(length**2 - y**2))"},
)
mistakes(
    "AS_NEAR_AS_POSSIBLE",
    "For points out of reach you put the carriage right below or above.",
    "There the rod does not reach: give None.",
).edit(
    "carriages",
    {
        "    if abs(y) > length:\n        return None\n": "",
        "(length**2 - y**2)": "(max(length**2 - y**2, 0.0))",
    },
)
mistakes(
    "WRONG_AXIS",
    "You took x for the distance from the rail.",
    "The rail is the line y = 0, so the distance from it is |y|.",
).around("carriages", "return _right(y, x, length)")
mistakes(
    "FROM_THE_ORIGIN",
    "You give None where the point is far from the origin.",
    "The carriage goes along the rail, so only the distance from the rail counts: |y|.",
).edit("carriages", {"if abs(y) > length:": "if math.hypot(x, y) > length:"})
mistakes(
    "HEIGHT_TO_EITHER_SIDE",
    "Your places are as far to either side as the point is high.",
    "If you take the angle of the rod, its height goes with the sine and its share along the rail with the cosine.",
).edit("carriages", {"math.sqrt(length**2 - y**2)": "y"})
mistakes(
    "NAN_FOR_NONE",
    "For points out of reach you give nan.",
    "The README asks for None there.",
)
mistakes(
    "X_AGAINST_THE_LENGTH",
    "You compared x with the length to see whether the rod reaches the point.",
    "The carriage goes along the rail, so only the distance from the rail counts: |y|.",
).edit("carriages", {"if abs(y) > length": "if abs(x) > length"})
mistakes(
    "GIVEN_ONCE",
    "Where the rod stands upright you give one place.",
    "Both places are the same there: give it twice.",
).edit("carriages", {"x - aside, x + aside": "tuple(sorted({x - aside, x + aside}))"})
mistakes(
    "BELOW_ONLY",
    "You find no place for points above the rail.",
    "The rod can turn in the whole plane. It reaches up as far as down: compare |y| with the length.",
)
mistakes(
    "SQUARE_AGAINST_THE_LENGTH",
    "You compare the square of y with the length.",
    "Compare |y| with the length, or the squares of both.",
).edit("carriages", {"if abs(y) > length:": "if y**2 > length:"})

mistakes.accept(
    "Solves (x - s)^2 + y^2 = length^2",
    """
        def carriages(x, y, length):
            import numpy as np

            under = length * length - y * y
            if under < 0:
                return None
            return np.array([x - under**0.5, x + under**0.5])
    """,
)
mistakes.accept(
    "Takes the angle of the rod",
    """
        def carriages(x, y, length):
            if not -length <= y <= length:
                return None
            angle = math.asin(y / length)
            return [x - length * math.cos(angle), x + length * math.cos(angle)]
    """,
)


def places(aside=lambda y, r: math.sqrt(r * r - y * y), order=1, start=1.0, out=None, high=abs):
    def carriages(x, y, length):
        if high(y) > length:
            return out
        side = aside(y, length)
        return (start * x - side, start * x + side)[::order]

    return carriages


mistakes.terms(
    "carriages",
    places,
    {
        "aside": {
            "SQUARES_ADDED": lambda y, r: math.hypot(y, r),
            "NO_ROOT": lambda y, r: r * r - y * y,
            "ROD_ALONG_THE_RAIL": lambda y, r: r,
            "LENGTHS_SUBTRACTED": lambda y, r: r - abs(y),
        },
        "order": {"LARGER_FIRST": -1},
        "start": {"X_FORGOTTEN": 0.0},
        "out": {"NAN_FOR_NONE": (math.nan, math.nan)},
        "high": {"BELOW_ONLY": lambda y: math.inf if y > 0 else -y},
    },
)
