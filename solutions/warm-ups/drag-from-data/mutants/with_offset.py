"""Fits a line with an offset."""


def damping(speeds, forces):
    import numpy as np

    return float(np.polyfit(speeds, forces, 1)[0])
