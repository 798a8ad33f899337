"""The smallest index by a key."""


def robust(costs):
    return min(range(len(costs)), key=lambda i: max(costs[i]))
