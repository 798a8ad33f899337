"""Means with one term wrong, or two."""

from course.scoring import kit


def mean_of(number=len, less=0, root=0.5):
    def rms(simulated, measured):
        return (sum((s - m) ** 2 for s, m in zip(simulated, measured)) / (number(measured) - less)) ** root

    return rms


def hypotheses():
    return kit.terms(
        "rms", mean_of, {"number": {"MEAN_FORGOTTEN": lambda values: 1}, "root": {"ROOT_MISSING": 1.0}}
    )
