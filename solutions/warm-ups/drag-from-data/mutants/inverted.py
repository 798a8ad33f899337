"""Fits speed against force."""


def damping(speeds, forces):
    return sum(v * f for v, f in zip(speeds, forces)) / sum(f * f for f in forces)
