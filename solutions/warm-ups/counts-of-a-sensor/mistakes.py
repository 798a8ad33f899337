"""Mistakes in `counts-of-a-sensor`: words beside the programs that they are true of."""

import math

from course.authoring.mistakes import Mistakes, with_terms

mistakes = Mistakes()

mistakes(
    "COUNTS_CUT_OFF",
    "Counts are rounded down, so the reading is half a count too small on average.",
    "Round to the nearest count.",
).edit("reading", {"min(round(distance": "min(int(distance"})
mistakes(
    "COUNTS_NOT_METRES",
    "Your result is a number of counts, not metres.",
    "Multiply by the resolution again.",
).edit("reading", {") * resolution,": "),"})
mistakes(
    "LIMIT_FORGOTTEN",
    "The limit is not used.",
    "Never return more than the limit.",
).body("reading", "return round(distance / resolution) * resolution")
mistakes(
    "COUNTS_FORGOTTEN",
    "The distance is not rounded to whole counts.",
    "Round distance / resolution, and multiply again.",
).edit("reading", {"round(distance / resolution) * resolution": "distance"})
mistakes(
    "COUNTS_ROUNDED_UP",
    "Counts are rounded up, so the reading is half a count too large on average.",
    "Round to the nearest count.",
)
mistakes(
    "DECIMAL_PLACES",
    "You rounded to decimal places. That fits only counts of 0.1 m, 0.01 m and so on.",
    "Divide by the resolution, round to a whole number, and multiply by the resolution again.",
).body(
    "reading",
    """
        import math

        digits = round(-math.log10(resolution))
        return min(round(distance, digits), limit)
    """,
)
mistakes(
    "LIMIT_IN_COUNTS",
    "You compared the counts with the limit, which is in metres.",
    "Turn the counts back into metres first.",
).edit("reading", {"* resolution, limit)": ", limit) * resolution"})
mistakes(
    "LIMIT_CUT_OFF",
    "The limit in counts is cut off: 0.29 / 0.01 comes out just below 29, and int() gives 28.",
    "Round it to the nearest whole number, or take the smaller of two lengths in metres.",
).body("reading", "return min(round(distance / resolution), int(limit / resolution)) * resolution")
mistakes(
    "NOTHING_BEYOND",
    "Beyond the limit your sensor does not read the limit.",
    "There the reading is the limit itself.",
).body(
    "reading",
    """
        value = round(distance / resolution) * resolution
        return value if value <= limit else 0.0
    """,
)
mistakes(
    "MULTIPLIED_FIRST",
    "You multiply by the resolution before you round, and divide by it afterwards.",
    "Divide the distance by the resolution: that is its counts. Multiply whole counts by it: that is metres.",
).edit("reading", {"round(distance / resolution) * resolution": "round(distance * resolution) / resolution"})
mistakes(
    "LARGER_OF_BOTH",
    "You take the larger of the rounded distance and the limit.",
    "A sensor never reads more than its limit: take the smaller.",
).edit("reading", {"min(": "max("})

mistakes.accept(
    "Rounds by hand",
    """
        def reading(distance, resolution, limit):
            import math

            counts = math.floor(distance / resolution + 0.5)
            return min(counts * resolution, limit)
    """,
)
mistakes.accept(
    "Cuts off before rounding",
    """
        def reading(distance, resolution, limit):
            return round(min(distance, limit) / resolution) * resolution
    """,
)


def reading_of(count=round, size=lambda resolution: resolution, most=lambda limit: limit):
    return lambda distance, resolution, limit: min(
        count(distance / resolution) * size(resolution), most(limit)
    )


def counted(distance, resolution, limit):
    """Compares metres with the limit, and gives counts."""
    count = round(distance / resolution)
    return limit if count * resolution > limit else count


def two_decimals(distance, resolution, limit):
    return min(round(distance, 2), limit)


def none_beyond(distance, resolution, limit):
    return None if distance > limit else round(distance / resolution) * resolution


def begins_again(distance, resolution, limit):
    """Counts on from zero beyond the limit."""
    return round(distance / resolution) % (round(limit / resolution) + 1) * resolution


@mistakes.more
def hypotheses():
    yield "reading", ("COUNTS_NOT_METRES",), counted
    yield "reading", ("DECIMAL_PLACES",), two_decimals
    yield "reading", ("NOTHING_BEYOND",), none_beyond
    yield "reading", ("NOTHING_BEYOND",), begins_again
    yield from with_terms(
        "reading",
        reading_of,
        {
            "count": {
                "COUNTS_CUT_OFF": math.floor,
                "COUNTS_ROUNDED_UP": math.ceil,
                "COUNTS_FORGOTTEN": lambda counts: counts,
            },
            "size": {"COUNTS_NOT_METRES": lambda resolution: 1.0},
            "most": {"LIMIT_FORGOTTEN": lambda limit: math.inf},
        },
    )
