"""As it stands in the file."""


def gap(first, second, k):
    return abs(second[k][0][0] - first[k][0][0])
