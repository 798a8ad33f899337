"""With NumPy."""


def rms(simulated, measured):
    import numpy as np

    return float(np.sqrt(np.mean(np.subtract(simulated, measured) ** 2)))
