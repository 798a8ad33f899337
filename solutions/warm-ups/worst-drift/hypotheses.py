"""Drifts with one term wrong, or two."""

from course.scoring import kit


def drift_of(worst=max, size=abs, share=abs):
    return lambda energies: worst([size(e - energies[0]) for e in energies]) / share(energies[0])


def hypotheses():
    return kit.terms(
        "worst_drift",
        drift_of,
        {
            "worst": {
                "LAST_NOT_WORST": lambda drifts: drifts[-1],
                "MEAN_NOT_WORST": lambda drifts: sum(drifts) / len(drifts),
            },
            "size": {"LOSSES_UNSEEN": lambda d: d},
            "share": {"NEGATIVE_SHARE": float, "NOT_A_SHARE": lambda e: 1.0},
        },
    )
