"""Takes the mean of all quotients."""


def damping(speeds, forces):
    return sum(f / v for v, f in zip(speeds, forces)) / len(speeds)
