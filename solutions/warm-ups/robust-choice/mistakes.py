"""Mistakes in `robust-choice`: words beside the programs that they are true of."""

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "BEST_ON_AVERAGE",
    "You take the controller that is best on average, however badly it does in one world.",
    "Compare the worst costs.",
).edit("robust", {"max(row)": "sum(row) / len(row)"})
mistakes(
    "BEST_CASE",
    "You take the controller with the smallest cost in any one world.",
    "You cannot count on that world: compare the worst costs.",
).edit("robust", {"max(row)": "min(row)"})
mistakes(
    "LARGEST_WORST",
    "You take the controller whose worst cost is the largest.",
    "Costs should be small: take the smallest of the worst.",
).edit("robust", {"index(min(worst": "index(max(worst"})
mistakes(
    "WORLDS_NOT_CONTROLLERS",
    "You compare the worlds: rows and columns are swapped.",
    "costs[i] is one controller in all worlds.",
).edit("robust", {"row) for row in costs": "column) for column in zip(*costs)"})
mistakes(
    "COST_NOT_INDEX",
    "Your result is the smallest worst cost itself.",
    "Give the index of the controller that has it.",
)
mistakes(
    "COUNTED_FROM_ONE",
    "Your index is one too large.",
    "The first controller has the index 0.",
)
mistakes(
    "LAST_OF_EQUALS",
    "Of equal controllers you take the last one.",
    "Take the first: compare with <, not <=.",
)
mistakes(
    "SMALLEST_SPREAD",
    "You take the controller whose costs differ the least.",
    "Costs that are all large differ little, too. Compare the worst costs.",
).edit("robust", {"max(row) for": "max(row) - min(row) for"})
mistakes(
    "COSTS_AS_REWARDS",
    "You take the controller whose smallest cost is the largest. That would be careful if the numbers were rewards.",
    "A small cost is good: the worst of a controller is its largest cost, and the smallest of these counts.",
).edit("robust", {"max(row)": "min(row)", "index(min": "index(max"})
mistakes(
    "LAST_WORLD",
    "You compare the costs in one world.",
    "Compare the largest cost of each controller.",
).edit("robust", {"max(row)": "row[-1]"})
mistakes(
    "COUNTED_THROUGH_ALL",
    "You look for the smallest of all costs, and count through every cost of every controller.",
    "Take the largest cost of each controller first. Then look for the smallest of these.",
).edit("robust", {"max(row) for row in costs": "cost for row in costs for cost in row"})
mistakes(
    "SIZES_OF_COSTS",
    "You compare the sizes of the costs, without their signs.",
    "A cost below zero is better than zero: compare the costs as they are.",
).edit("robust", {"max(row) for": "max(map(abs, row)) for"})
mistakes(
    "COSTS_NOT_INDEX",
    "Your result is the list of the controller's costs, not its index.",
    "Give its place in the list.",
).body("robust", "return min(costs, key=max)")
mistakes(
    "WORST_FROM_ZERO",
    "The search for the worst cost starts at 0, so no cost below 0 can be the worst.",
    "Start with the first cost of the row, or take max(row).",
).edit("robust", {"max(row)": "max(0.0, *row)"})
mistakes(
    "SMALLEST_REGRET",
    "Your controller has the smallest regret: in each world you compare it with the best one there.",
    "Compare the worst costs themselves.",
).body(
    "robust",
    """
        best = [min(world) for world in zip(*costs)]
        regret = [max(cost - least for cost, least in zip(row, best)) for row in costs]
        return regret.index(min(regret))
    """,
)

mistakes.accept(
    "The smallest index by a key",
    """
        def robust(costs):
            return min(range(len(costs)), key=lambda i: max(costs[i]))
    """,
)
mistakes.accept(
    "With NumPy",
    """
        def robust(costs):
            import numpy as np

            return int(np.argmin(np.max(np.asarray(costs), axis=1)))
    """,
)


def cost(costs):
    return min(max(row) for row in costs)


def last_of_equals(costs):
    worst = [max(row) for row in costs]
    return len(worst) - 1 - worst[::-1].index(min(worst))


@mistakes.more
def hypotheses():
    yield "robust", ("COST_NOT_INDEX",), cost
    yield "robust", ("COUNTED_FROM_ONE",), lambda costs: [max(row) for row in costs].index(cost(costs)) + 1
    yield "robust", ("LAST_OF_EQUALS",), last_of_equals
    yield "robust", ("LAST_WORLD",), lambda costs: min(range(len(costs)), key=lambda i: costs[i][0])
