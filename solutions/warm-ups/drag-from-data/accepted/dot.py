"""Two dot products."""


def damping(speeds, forces):
    import numpy as np

    return np.dot(speeds, forces) / np.dot(speeds, speeds)
