"""Good in every world."""


def robust(costs):
    """Index of the controller whose worst cost is the smallest.

    Args:
        costs: a list for each controller, with its cost in each world.

    Returns:
        int; if several are equal, the first.
    """
    raise NotImplementedError
