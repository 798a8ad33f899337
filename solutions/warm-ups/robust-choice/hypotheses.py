"""Choices that are made, or given back, in a wrong way."""


def cost(costs):
    return min(max(row) for row in costs)


def last_of_equals(costs):
    worst = [max(row) for row in costs]
    return len(worst) - 1 - worst[::-1].index(min(worst))


def hypotheses():
    yield "robust", ("COST_NOT_INDEX",), cost
    yield "robust", ("COUNTED_FROM_ONE",), lambda costs: [max(row) for row in costs].index(cost(costs)) + 1
    yield "robust", ("LAST_OF_EQUALS",), last_of_equals
