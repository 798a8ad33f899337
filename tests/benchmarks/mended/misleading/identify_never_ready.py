"""A fit that takes too long."""


def identify(t, u, y):
    total = 0
    for i in range(10**12):
        total += i
    return total
