"""Mistakes in `late-reading`: words beside the programs that they are true of."""

from course.authoring.mistakes import Mistakes, with_terms

mistakes = Mistakes()

mistakes(
    "NO_LATENCY",
    "Values are read at the moment they are taken.",
    "Each arrives its latency later.",
).edit("seen", {" + latency": ""})
mistakes(
    "FROM_THE_FUTURE",
    "The function sees values that have not been taken yet: the latency has the wrong sign.",
    "A value that arrives now was taken at now minus latency.",
).edit("seen", {"time + latency <= now": "time <= now + latency"})
mistakes(
    "ARRIVAL_NOT_COUNTED",
    "A value that arrives exactly now is not counted.",
    "Count it: compare with <=, or look its place up with bisect_right.",
).edit("seen", {"<= now": "< now"})
mistakes(
    "NEAREST_NOT_NEWEST",
    "You take the value whose arrival is nearest, even if it has not arrived yet.",
    "Look for the last among those that have arrived, and at no others.",
).body(
    "seen",
    """
        k = min(range(len(times)), key=lambda k: abs(times[k] + latency - now))
        return values[k]
    """,
)
mistakes(
    "OLDEST_NOT_NEWEST",
    "You take the first value that has arrived, which is the oldest.",
    "Go on to the last value that has arrived, or begin to look at the end.",
)
mistakes(
    "INDEX_NOT_VALUE",
    "Your result is the number of the sample, not its value.",
    "Give values[k].",
)
mistakes(
    "LAST_FOR_NONE",
    "Where nothing has arrived yet you give the last value. The index -1 does that.",
    "Give None there.",
)
mistakes(
    "FIRST_FOR_NONE",
    "Where nothing has arrived yet you give the first value.",
    "Give None there.",
)
mistakes(
    "ZERO_IS_NONE",
    "You give None where the newest value is 0.",
    "Python takes 0 for false in `or` and in `if value`. Ask whether anything has arrived, not what.",
).edit("seen", {"arrived[-1] if arrived": "(arrived[-1] or None) if arrived"})
mistakes(
    "FIRST_IS_NONE",
    "You give None where only the first value has arrived.",
    "Its index is 0, which Python takes for false. Ask whether one has arrived, not whether its index is above 0.",
).edit("seen", {"if arrived else": "if len(arrived) > 1 else"})
mistakes(
    "LARGEST_NOT_NEWEST",
    "You take the largest value that has arrived.",
    "Newest means the latest: take the last of those that have arrived.",
).edit("seen", {"arrived[-1]": "max(arrived)"})
mistakes(
    "ALL_ARRIVED_IS_NONE",
    "You give None where all values have arrived.",
    "Where no value is still on its way, give the last one.",
).edit("seen", {"if arrived else": "if 0 < len(arrived) < len(times) else"})
mistakes(
    "ONE_TOO_EARLY",
    "You give the value before the newest one that has arrived.",
    "Of those that have arrived, the last one counts: its index is their number less one.",
).edit("seen", {"arrived[-1] if arrived": "arrived[-2] if len(arrived) > 1"})
mistakes(
    "ONE_TOO_LATE",
    "You give the first value that has not arrived yet.",
    "Give the one before it.",
).body("seen", "return next((value for time, value in zip(times, values) if time + latency > now), None)")
mistakes(
    "TIME_NOT_VALUE",
    "Your result is the time of the sample, not its value.",
    "Give the value that was taken at that time.",
).edit("seen", {"value for time": "time for time"})
mistakes(
    "INTERPOLATED",
    "You give a number between two values, which the sensor has not measured.",
    "Give the last value that has arrived, as it is.",
).body(
    "seen",
    """
        import numpy as np

        return float(np.interp(now - latency, times, values)) if now >= times[0] + latency else None
    """,
)
mistakes(
    "ONLY_WHAT_ARRIVES_NOW",
    "You give None unless a value arrives exactly now.",
    "An earlier one still counts: give the last that has arrived.",
).body("seen", "return {time + latency: value for time, value in zip(times, values)}.get(now)")
mistakes(
    "SAMPLES_NOT_TIME",
    "You go back a fixed number of samples: the latency divided by the time between the first two.",
    "The samples need not be evenly spaced: for each, compare its time plus the latency with now.",
).body(
    "seen",
    """
        taken = [value for time, value in zip(times, values) if time <= now]
        late = round(latency / (times[1] - times[0]))
        return taken[-1 - late] if late < len(taken) else None
    """,
)

mistakes.accept(
    "Goes from the newest to the oldest",
    """
        def seen(times, values, latency, now):
            for k in range(len(times) - 1, -1, -1):
                if times[k] <= now - latency:
                    return values[k]
            return None
    """,
)
mistakes.accept(
    "Looks the place up",
    """
        def seen(times, values, latency, now):
            from bisect import bisect_right

            place = bisect_right(times, now - latency)
            return values[place - 1] if place else None
    """,
)


def reading_of(late=1.0, arrived=lambda t, now: t <= now, which=-1, none=lambda values: None):
    def seen(times, values, latency, now):
        found = [value for t, value in zip(times, values) if arrived(t + late * latency, now)]
        return found[which] if found else none(values)

    return seen


def index(times, values, latency, now):
    arrived = [k for k, t in enumerate(times) if t + latency <= now]
    return arrived[-1] if arrived else None


def nearest_if_any(times, values, latency, now):
    if not times or times[0] + latency > now:
        return None
    return values[min(range(len(times)), key=lambda k: abs(times[k] + latency - now))]


def falls_off(times, values, latency, now):
    for k, time in enumerate(times):
        if time + latency > now:
            return values[k - 1]
    return None


def one_too_far(times, values, latency, now):
    place = sum(time + latency <= now for time in times)
    return values[min(place, len(values) - 1)] if place else None


@mistakes.more
def hypotheses():
    yield "seen", ("INDEX_NOT_VALUE",), index
    yield "seen", ("ONE_TOO_LATE",), one_too_far
    yield "seen", ("NEAREST_NOT_NEWEST",), nearest_if_any
    yield "seen", ("LAST_FOR_NONE", "ALL_ARRIVED_IS_NONE"), falls_off
    yield from with_terms(
        "seen",
        reading_of,
        {
            "late": {"NO_LATENCY": 0.0, "FROM_THE_FUTURE": -1.0},
            "arrived": {"ARRIVAL_NOT_COUNTED": lambda t, now: t < now},
            "which": {"OLDEST_NOT_NEWEST": 0},
            "none": {"LAST_FOR_NONE": lambda values: values[-1], "FIRST_FOR_NONE": lambda values: values[0]},
        },
    )
