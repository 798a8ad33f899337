"""Arrays and a norm."""


def shadow_gap(a, b, direction):
    import numpy as np

    n = np.asarray(direction, dtype=float)
    n = n / np.linalg.norm(n)
    on_a, on_b = np.asarray(a) @ n, np.asarray(b) @ n
    return float(max(on_b.min() - on_a.max(), on_a.min() - on_b.max()))
