"""Mistakes in `overlap-of-balls`: words beside the programs that they are true of."""

import math

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "GAP_NOT_DEPTH",
    "The sign is reversed: it is the gap, not the depth.",
    "Deep means positive: radii minus distance.",
).edit("overlap", {"r1 + r2 - math.dist(p, q)": "math.dist(p, q) - r1 - r2"})
mistakes(
    "DISTANCE_SQUARED",
    "You took the squared distance for the distance.",
    "Take the root: metres cannot be compared with square metres.",
).edit("overlap", {"math.dist(p, q)": "(q[0] - p[0]) ** 2 - (q[1] - p[1]) ** 2"})
mistakes(
    "ONE_RADIUS",
    "Only the larger radius counts.",
    "Surfaces meet when the centres are r1 + r2 apart.",
).edit("overlap", {"return r1 + r2 -": "return max(r1, r2) -"})
mistakes(
    "GAP_CUT_OFF",
    "A gap gives zero here.",
    "A gap should be negative: give the radii less the distance there, too.",
).edit("overlap", {"r1 + r2 - math.dist(p, q": "max(0.0, r1 + r2 - math.dist(p, q)"})
mistakes(
    "SIZES_ADDED",
    "You added the differences in x and in y, as if one had to walk round a corner.",
    "The straight distance is the root of the sum of their squares: math.dist(p, q).",
)
mistakes(
    "RADII_HALVED",
    "You halved the radii, as if they were diameters.",
    "Balls that just touch have their centres r1 + r2 apart.",
)
mistakes(
    "DIAMETERS",
    "You doubled the radii.",
    "Balls that just touch have their centres r1 + r2 apart.",
)
mistakes(
    "ONE_RADIUS_ONLY",
    "Only one of the two radii counts.",
    "Balls that just touch have their centres r1 + r2 apart.",
).edit("overlap", {"r1 + r2": "r1"})
mistakes(
    "RADII_SUBTRACTED",
    "You subtracted the radii from each other.",
    "Balls that just touch have their centres r1 + r2 apart: add them.",
).edit("overlap", {"r1 + r2": "abs(r1 - r2)"})
mistakes(
    "SQUARES_COMPARED",
    "You subtracted the square of the distance from the square of the radii's sum.",
    "Squares tell whether two balls overlap, but not how far: subtract the lengths.",
).edit("overlap", {"r1 + r2 - math.dist(p, q)": "(r1 + r2) ** 2 - math.dist(p, q) ** 2"})
mistakes(
    "SIZE_ONLY",
    "You took the size of the depth, so a gap counts as an overlap.",
    "Leave out the abs: a gap is negative.",
).edit("overlap", {"r1 + r2 - math.dist(p, q)": "abs(r1 + r2 - math.dist(p, q))"})
mistakes(
    "ONE_COORDINATE",
    "Only one coordinate counts in your distance, or only the larger difference.",
    "The balls lie in a plane: the distance of their centres is math.dist(p, q).",
)
mistakes(
    "FROM_THE_ORIGIN",
    "You subtract how far p and q are from the origin.",
    "Subtract the coordinates first: the distance of the centres is math.dist(p, q).",
).edit("overlap", {"math.dist(p, q)": "abs(math.hypot(*p) - math.hypot(*q))"})
mistakes(
    "DEPTH_LIMITED",
    "The depth is never more than the smaller ball's diameter.",
    "It is r1 + r2 minus the distance, however deep one lies in the other.",
).edit("overlap", {"r1 + r2 - math.dist(p, q)": "min(r1 + r2 - math.dist(p, q), 2 * r1, 2 * r2)"})
mistakes(
    "AXES_MIXED",
    "You subtract an x from a y, or a y from an x.",
    "Subtract x from x and y from y: q[0] - p[0] and q[1] - p[1].",
)
mistakes(
    "COORDINATES_ADDED",
    "You add the coordinates of the two centres.",
    "Subtract them: the distance of the centres is math.dist(p, q).",
)

mistakes.accept(
    "Pythagoras by hand",
    """
        def overlap(p, q, r1, r2):
            dx, dy = q[0] - p[0], q[1] - p[1]
            return r1 + r2 - (dx * dx + dy * dy) ** 0.5
    """,
)
mistakes.accept(
    "Centres as complex numbers",
    """
        def overlap(p, q, r1, r2):
            return r1 + r2 - abs(complex(*p) - complex(*q))
    """,
)


def depth(distance=math.dist, radii=lambda a, b: a + b, sign=1.0):
    return lambda p, q, r1, r2: sign * (radii(r1, r2) - distance(p, q))


mistakes.terms(
    "overlap",
    depth,
    {
        "distance": {
            "DISTANCE_SQUARED": lambda p, q: math.dist(p, q) ** 2,
            "ONE_COORDINATE": lambda p, q: abs(p[0] - q[0]),
            "SIZES_ADDED": lambda p, q: abs(p[0] - q[0]) + abs(p[1] - q[1]),
            "COORDINATES_ADDED": lambda p, q: math.hypot(p[0] + q[0], p[1] + q[1]),
        },
        "radii": {
            "ONE_RADIUS": max,
            "RADII_HALVED": lambda a, b: (a + b) / 2,
            "DIAMETERS": lambda a, b: 2 * (a + b),
        },
        "sign": {"GAP_NOT_DEPTH": -1.0},
    },
)


def mixed(i, j):
    return lambda p, q: math.hypot(p[0] - q[i], p[1] - q[j])


@mistakes.more
def hypotheses():
    yield "overlap", ("ONE_RADIUS_ONLY",), depth(radii=lambda a, b: b)
    yield "overlap", ("ONE_RADIUS_ONLY",), depth(radii=min)
    yield "overlap", ("ONE_COORDINATE",), depth(lambda p, q: abs(p[1] - q[1]))
    yield "overlap", ("ONE_COORDINATE",), depth(lambda p, q: max(abs(p[0] - q[0]), abs(p[1] - q[1])))
    for i, j in ((0, 0), (1, 1), (1, 0)):
        yield "overlap", ("AXES_MIXED",), depth(mixed(i, j))
        yield "overlap", ("AXES_MIXED",), depth(lambda p, q, right=mixed(i, j): right(q, p))
    yield "overlap", ("AXES_MIXED",), depth(lambda p, q: math.hypot(p[0] - p[1], q[0] - q[1]))
