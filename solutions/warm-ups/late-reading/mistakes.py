"""Mistakes in `late-reading`: words beside the programs that they are true of."""

from course.authoring.mistakes import Mistakes, with_terms

mistakes = Mistakes()

mistakes(
    "NO_LATENCY",
    "Values are read at the moment they are taken.",
    "Each arrives its latency later.",
).edit(
    "seen",
    {
        "value for time, value in zip(times, values) if time + latency": "v for t, v in zip(times, values) if t"
    },
)
mistakes(
    "FROM_THE_FUTURE",
    "The function sees values that have not been taken yet: the latency has the wrong sign.",
    "A value that arrives now was taken at now minus latency.",
).edit(
    "seen",
    {
        "value for time, value in zip(times, values) if time + latency <= now": "v for t, v in zip(times, values) if t <= now + latency"
    },
)
mistakes(
    "ARRIVAL_NOT_COUNTED",
    "A value that arrives exactly now is not counted.",
    "Compare with <=.",
).edit(
    "seen",
    {
        "value for time, value in zip(times, values) if time + latency <=": "v for t, v in zip(times, values) if t + latency <"
    },
)
mistakes(
    "NEAREST_NOT_NEWEST",
    "You take the value whose arrival is nearest, even if it has not arrived yet.",
    "Only values that have arrived can be read; before the first arrival there is none.",
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


@mistakes.more
def hypotheses():
    yield "seen", ("INDEX_NOT_VALUE",), index
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
