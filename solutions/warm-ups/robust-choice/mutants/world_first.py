"""Goes through worlds instead of controllers."""


def robust(costs):
    worst = [max(column) for column in zip(*costs)]
    return worst.index(min(worst))
