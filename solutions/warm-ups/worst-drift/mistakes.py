"""Mistakes in `worst-drift`: words beside the programs that they are true of."""

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "LAST_NOT_WORST",
    "Only the last value is compared with the first, so a drift that came back does not count.",
    "Take the largest distance of all.",
)
mistakes(
    "LOSSES_UNSEEN",
    "The differences keep their signs, so a loss of energy never counts as the worst.",
    "Take the size of each difference, whatever its sign.",
).edit("worst_drift", {"abs(energy - energies[0])": "energy - energies[0]"})
mistakes(
    "RANGE_NOT_DRIFT",
    "You measure from the smallest to the largest value.",
    "Measure from the first value: the energy should have stayed there.",
).edit(
    "worst_drift", {"max(abs(energy - energies[0]) for energy in energies": "(max(energies) - min(energies)"}
)
mistakes(
    "NEGATIVE_SHARE",
    "A negative first energy gives a negative drift.",
    "Divide by the size of the first value.",
).edit("worst_drift", {"abs(energies[0])": "energies[0]"})
mistakes(
    "NOT_A_SHARE",
    "Your result is in J, not a share.",
    "Divide by the size of the first value.",
)
mistakes(
    "MEAN_NOT_WORST",
    "You take the mean of the distances.",
    "Take the largest of them.",
)
mistakes(
    "FROM_ONE_TO_THE_NEXT",
    "You compare each value with the one before it.",
    "A slow drift is made of small changes. Compare each value with the first.",
).body("worst_drift", "return max(abs(b - a) for a, b in zip(energies, energies[1:])) / abs(energies[0])")
mistakes(
    "SHARE_OF_ITSELF",
    "You divide each distance by the value of that moment.",
    "The drift is a share of the first value: divide by that.",
).body("worst_drift", "return max(abs(energy - energies[0]) / abs(energy) for energy in energies)")
mistakes(
    "PER_CENT",
    "Your result is in per cent.",
    "Leave out the factor of 100.",
).edit("worst_drift", {"/ abs(energies[0])": "/ abs(energies[0]) * 100"})
mistakes(
    "SHARE_OF_THE_LARGEST",
    "You divide by the value that is the largest, or the largest in size.",
    "Divide by the size of the first value.",
).edit("worst_drift", {"abs(energies[0])": "max(abs(energy) for energy in energies)"})
mistakes(
    "FROM_THE_MEAN",
    "You measure the distances from the mean of all values.",
    "Measure them from the first value.",
).body(
    "worst_drift",
    """
        mean = sum(energies) / len(energies)
        return max(abs(energy - mean) for energy in energies) / abs(mean)
    """,
)

mistakes.accept(
    "A loop that remembers the worst",
    """
        def worst_drift(energies):
            first, worst = energies[0], 0.0
            for energy in energies[1:]:
                if abs(energy - first) > worst:
                    worst = abs(energy - first)
            return worst / abs(first)
    """,
)
mistakes.accept(
    "With NumPy",
    """
        def worst_drift(energies):
            import numpy as np

            e = np.asarray(energies, dtype=float)
            return float(np.max(np.abs(e / e[0] - 1.0)))
    """,
)


def drift_of(worst=max, size=abs, share=abs):
    return lambda energies: worst([size(e - energies[0]) for e in energies]) / share(energies[0])


mistakes.terms(
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


def of_the_largest(size):
    return lambda energies: max(abs(energy - energies[0]) for energy in energies) / size(max(energies))


def mean_over_first(energies):
    mean = sum(energies) / len(energies)
    return max(abs(energy - mean) for energy in energies) / abs(energies[0])


@mistakes.more
def other_values():
    yield "worst_drift", ("SHARE_OF_THE_LARGEST",), of_the_largest(float)
    yield "worst_drift", ("SHARE_OF_THE_LARGEST",), of_the_largest(abs)
    yield "worst_drift", ("FROM_THE_MEAN",), mean_over_first
