"""With NumPy."""


def standard_error(values):
    import numpy as np

    return float(np.std(values, ddof=1) / np.sqrt(len(values)))
