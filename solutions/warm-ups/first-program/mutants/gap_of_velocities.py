"""Takes the wrong one of the pair."""


def gap(first, second, k):
    return abs(second[k][1] - first[k][1])
