"""Means with one term wrong, or two."""

from course.scoring import kit


def mean_of(power=2, less=0, root=0.5):
    def rms(simulated, measured):
        return (
            sum(abs(s - m) ** power for s, m in zip(simulated, measured)) / (len(measured) - less)
        ) ** root

    return rms


def hypotheses():
    return kit.terms("rms", mean_of, {"less": {"ONE_LESS": 1}, "root": {"ROOT_MISSING": 1.0}})
