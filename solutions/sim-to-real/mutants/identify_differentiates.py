"""Force balance with the speed differentiated: m a + b v + Fc sign(v) = force."""

_by_integrals = identify


def identify(t, u, y):
    found = _by_integrals(t, u, y)
    tau, late = found["tau"][0], found["latency"][0]
    force = np.gradient(delayed(motor_impulse(u, tau), late), H)
    X = np.stack([np.gradient(y, H), y, np.sign(y)], axis=1)
    theta = np.linalg.lstsq(X, force)[0]
    for name, value in zip(("m", "b", "Fc"), theta.tolist()):
        half = found[name][2] - found[name][0]
        found[name] = [value, value - half, value + half]
    return found
