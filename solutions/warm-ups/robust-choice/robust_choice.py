"""Good in every world: the model solution."""


def robust(costs):
    """Index of the design whose worst cost is the smallest."""
    worst = [max(row) for row in costs]
    return worst.index(min(worst))
