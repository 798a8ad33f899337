"""With NumPy."""


def robust(costs):
    import numpy as np

    return int(np.argmin(np.max(np.asarray(costs), axis=1)))
