"""Takes the largest."""


def robust(costs):
    worst = [max(row) for row in costs]
    return worst.index(max(worst))
