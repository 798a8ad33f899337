"""With NumPy's least squares."""


def damping(speeds, forces):
    import numpy as np

    solution, *_ = np.linalg.lstsq(np.asarray(speeds)[:, None], np.asarray(forces), rcond=None)
    return float(solution[0])
