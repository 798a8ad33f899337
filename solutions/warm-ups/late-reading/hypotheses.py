"""Readings with one term wrong, or two."""

from course.scoring import kit


def reading_of(late=1.0, arrived=lambda t, now: t <= now, which=-1, none=lambda values: None):
    def seen(times, values, latency, now):
        found = [value for t, value in zip(times, values) if arrived(t + late * latency, now)]
        return found[which] if found else none(values)

    return seen


def index(times, values, latency, now):
    arrived = [k for k, t in enumerate(times) if t + latency <= now]
    return arrived[-1] if arrived else None


def hypotheses():
    yield "seen", ("INDEX_NOT_VALUE",), index
    yield from kit.terms(
        "seen",
        reading_of,
        {
            "late": {"NO_LATENCY": 0.0, "FROM_THE_FUTURE": -1.0},
            "arrived": {"ARRIVAL_NOT_COUNTED": lambda t, now: t < now},
            "which": {"OLDEST_NOT_NEWEST": 0},
            "none": {"LAST_FOR_NONE": lambda values: values[-1], "FIRST_FOR_NONE": lambda values: values[0]},
        },
    )
