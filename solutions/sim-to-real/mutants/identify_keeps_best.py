"""Wrong: the refinement starts from the best point of the grid of all calls so far."""

_best = (0.0, 0.0, 0.0)


def identify(t, u, y):
    # m v = impulse - b * integral of v - Fc * integral of sign(v), so v is linear in 1/m, b/m and Fc/m once
    # lag and latency are known: a grid for these two, least squares for the rest.
    v = in_blocks(y).reshape(-1)
    friction = in_blocks(np.stack([cumulative(y), cumulative(np.sign(y))], axis=1)).reshape(-1, 2)
    Q, _ = np.linalg.qr(friction)
    rest = v - Q @ (Q.T @ v)  # what friction alone cannot explain
    global _best
    for tau in np.arange(0.02, 0.151, 0.02):
        impulse = motor_impulse(u, tau)
        trials = np.stack([delayed(impulse, late) for late in np.arange(0.02, 0.201, 0.01)], axis=1)
        trials = in_blocks(trials).reshape(len(v), -1)
        trials -= Q @ (Q.T @ trials)
        explained = (rest @ trials) ** 2 / np.sum(trials**2, axis=0)
        k = int(explained.argmax())
        _best = max(_best, (float(explained[k]), float(tau), 0.02 + 0.01 * k))
    _, tau, late = _best

    # Newton's method from there: two more columns say how the impulse changes with tau and latency.
    d = 0.001
    for _ in range(1):
        impulse = motor_impulse(u, tau)
        by_tau = (motor_impulse(u, tau + d) - motor_impulse(u, tau - d)) / (2 * d)
        by_late = (delayed(impulse, late + d) - delayed(impulse, late - d)) / (2 * d)
        columns = [
            delayed(impulse, late),
            cumulative(y),
            cumulative(np.sign(y)),
            delayed(by_tau, late),
            by_late,
        ]
        X = in_blocks(np.stack(columns, axis=1))
        XX = X.transpose(0, 2, 1) @ X  # one 5 x 5 matrix and one vector per block
        Xv = (X.transpose(0, 2, 1) @ in_blocks(y))[..., 0]
        start = tau, late
        theta = np.linalg.solve(XX.sum(axis=0), Xv.sum(axis=0))
        value = _parameters(theta, *start)
        tau, late = np.clip(value[3:5], [0.005, 0.0], [0.2, 0.3])

    # Jackknife: leave out one block after the other. Noise in y is also in its integrals, so the residuals
    # of one block hang together, and the usual formula, which counts each sample, would be overconfident.
    left_out = np.linalg.solve(XX.sum(axis=0) - XX, (Xv.sum(axis=0) - Xv)[..., None])[..., 0]
    each = _parameters(left_out, *start)
    n = len(each)
    half = 2.1 * np.sqrt((n - 1) / n * np.sum((each - each.mean(axis=0)) ** 2, axis=0))
    names = (*NAMES, "lag")
    return {name: [float(x), float(x - w), float(x + w)] for name, x, w in zip(names, value, half)}
