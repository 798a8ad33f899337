"""Mistakes in `way-out`: words beside the programs that they are true of."""

import math

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "ALWAYS_ALONG_Y",
    "Your box always moves along y.",
    "Sometimes the way along x is shorter.",
).edit("way_out", {"    if along < across:\n        return math.copysign(along, x), 0.0\n": ""})
mistakes(
    "LONGER_WAY",
    "You took the longer way out.",
    "Move along the axis where the overlap is smaller.",
).edit("way_out", {"if along < across:": "if along > across:"})
mistakes(
    "INTO_EACH_OTHER",
    "You move the second box towards the first.",
    "It has to move to the side where it is already.",
).edit("way_out", {"return math": "return -math", "0.0, math": "0.0, -math"})
mistakes(
    "ALWAYS_FORWARDS",
    "Your box always moves to the right or up.",
    "If the second box is to the left or below, it moves that way.",
).edit("way_out", {"math.copysign(along, x)": "along", "math.copysign(across, y)": "across"})
mistakes(
    "BOTH_WAYS",
    "You move along x and along y.",
    "One of the two is enough: the shorter.",
).edit("way_out", {"if along < across:\n        return": "return", ", 0.0\n    return 0.0, math": ", math"})
mistakes(
    "HALF_SIZES",
    "Your boxes are half as large.",
    "Half of each box lies towards the other, so they touch one whole width apart.",
).edit("way_out", {"- abs(x), height": "/ 2 - abs(x), height / 2"})
mistakes(
    "NOT_ASKED",
    "You move boxes that are apart in both directions or in one.",
    "Give (0, 0) unless both depths are positive.",
).edit(
    "way_out",
    {
        "    if along <= 0 or across <= 0:\n        return 0.0, 0.0\n": "",
        "math.copysign(along, x)": "(along if x > 0 else -along)",
        "math.copysign(across, y)": "(across if y > 0 else -across)",
    },
)
mistakes(
    "EITHER_IS_ENOUGH",
    "You move boxes that overlap along one axis only.",
    "A single direction in which they are apart is enough: give (0, 0) unless both depths are positive.",
).edit(
    "way_out",
    {
        "<= 0 or": "<= 0 and",
        "math.copysign(along, x)": "(along if x > 0 else -along)",
        "math.copysign(across, y)": "(across if y > 0 else -across)",
    },
)
mistakes(
    "MIDDLES_COMPARED",
    "You chose the axis by x and y themselves.",
    "In long boxes the middles are far apart and the overlap is still deep: compare the depths.",
).edit("way_out", {"if along < across:": "if abs(x) > abs(y):"})
mistakes(
    "NEW_PLACE",
    "You gave the new place of the second box.",
    "Give the move: the new place less the old one.",
).edit(
    "way_out",
    {
        "return math.copysign(along, x), 0.0": "return x + math.copysign(along, x), y",
        "return 0.0, math": "return x, y + math",
    },
)
mistakes(
    "MOVED_BY_THE_DISTANCE",
    "You move the box by the distance of the middles.",
    "It has to move by the depth: the width less |x|, or the height less |y|.",
).edit("way_out", {"math.copysign(along, x)": "x", "math.copysign(across, y)": "y"})
mistakes(
    "NO_SIZE_OF_X",
    "Your depths are wrong where x or y is negative.",
    "The depth is the width less |x|, whichever side the box is on.",
).edit("way_out", {"abs(x), height - abs(y)": "x, height - y"})
mistakes(
    "HALF_THE_MOVE",
    "You move the second box by half the depth.",
    "The first box stays, so the second moves the whole depth.",
).edit("way_out", {"width - abs(x), height - abs(y)": "(width - abs(x)) / 2, (height - abs(y)) / 2"})
mistakes(
    "DEPTH_OF_THE_OTHER",
    "Along y your box moves by the depth along x.",
    "Along y the depth is height - |y|.",
).edit("way_out", {".copysign(across, y": ".copysign(along, y"})
mistakes(
    "NEGATIVE_DEPTHS",
    "The second box moves towards the first, along the axis where it is the longer way.",
    "Take the depths width - |x| and height - |y|. The smaller one decides, and the box moves to the side where it is already.",
).body(
    "way_out",
    """
        along, across = abs(x) - width, abs(y) - height
        if along > 0 or across > 0:
            return 0.0, 0.0
        if along < across:
            return (along if x > 0 else -along), 0.0
        return 0.0, (across if y > 0 else -across)
    """,
)
mistakes(
    "AXES_SWAPPED",
    "dx and dy are swapped.",
    "The move along x comes first.",
).edit(
    "way_out",
    {
        "math.copysign(along, x), 0.0": "0.0, math.copysign(along, x)",
        "0.0, math.copysign(across, y)": "math.copysign(across, y), 0.0",
    },
)
mistakes(
    "CHOSEN_BY_SIZE",
    "You chose the axis by the size of the boxes.",
    "Compare how deep they overlap along each axis.",
).edit("way_out", {"if along < across:": "if width < height:"})
mistakes(
    "RELATIVE_DEPTHS",
    "You compared the depths as shares of the width and the height.",
    "The move is a length: compare the depths themselves, in m.",
).edit("way_out", {"if along < across:": "if along / width < across / height:"})
mistakes(
    "SIGN_OF_X",
    "Along y your box moves by the sign of x.",
    "Along y the sign of y counts: the box moves to the side where it is already.",
).edit("way_out", {".copysign(across, y": ".copysign(across, x"})
mistakes(
    "SIGN_OF_Y",
    "Along x your box moves by the sign of y.",
    "Along x the sign of x counts: the box moves to the side where it is already.",
).edit("way_out", {".copysign(along, x": ".copysign(along, y"})
mistakes(
    "SIZES_SWAPPED",
    "Width and height are exchanged.",
    "The width is along x, the height along y.",
).around("way_out", "return _right(x, y, height, width)")
mistakes(
    "LITTLE_LEFT_ALONE",
    "You leave boxes alone that overlap a little.",
    "Every overlap counts, however small: give (0, 0) only where a depth is zero or negative.",
).edit("way_out", {"along <= 0 or across <= 0": "along <= 0.01 or across <= 0.01"})

mistakes.accept(
    "Tries all four ways",
    """
        def way_out(x, y, width, height):
            ways = [(width - x, (1, 0)), (width + x, (-1, 0)), (height - y, (0, 1)), (height + y, (0, -1))]
            depth, (sx, sy) = min(ways)
            return (depth * sx, depth * sy) if depth > 0 else (0, 0)
    """,
)
mistakes.accept(
    "Arrays",
    """
        def way_out(x, y, width, height):
            import numpy as np

            centre = np.array([x, y])
            depth = np.array([width, height]) - abs(centre)
            move = np.zeros(2)
            if (depth > 0).all():
                k = depth.argmin()
                move[k] = depth[k] * np.sign(centre[k])
            return move
    """,
)


def without_sizes(x, y, width, height):
    along, across = width - x, height - y
    if along <= 0 or across <= 0:
        return 0.0, 0.0
    return (along, 0.0) if along < across else (0.0, across)


def without_asking(x, y, width, height):
    along, across = width - abs(x), height - abs(y)
    return (math.copysign(along, x), 0.0) if along < across else (0.0, math.copysign(across, y))


@mistakes.more
def hypotheses():
    yield "way_out", ("NO_SIZE_OF_X", "ALWAYS_FORWARDS"), without_sizes
    yield "way_out", ("NOT_ASKED",), without_asking
