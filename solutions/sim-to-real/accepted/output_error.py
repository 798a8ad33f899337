"""Output error: simulated speeds against measured ones, starting from the result of the integral fit."""


def _simulated(u, p):
    m, b, Fc, tau, late = p
    n, h = len(u), H / 2
    ends = np.interp(h * np.arange(2 * n + 1) - late, H * np.arange(n + 1), np.r_[0.0, np.cumsum(u) * H])
    heard = (np.diff(ends) / h).tolist()
    keep = math.exp(-h / tau)
    mean = tau * (1 - keep) / h
    v = f = 0.0
    speeds = []
    for i, command in enumerate(heard):
        if i % 2 == 0:
            speeds.append(v)
        behind = f - command
        v = (v + h / m * (command + behind * mean)) / (1 + h * b / m)
        v = max(v - h * Fc / m, 0.0) if v > 0 else min(v + h * Fc / m, 0.0)
        f = command + behind * keep
    return np.array(speeds)


_by_integrals = identify


def identify(t, u, y):
    start = _by_integrals(t, u, y)
    p = np.array([start[name][0] for name in NAMES])
    for _ in range(2):
        model = _simulated(u, p)
        J = np.stack([(_simulated(u, p * (1 + 0.01 * e)) - model) / 0.01 for e in np.eye(5)], axis=1)
        A = J.T @ J
        p = p * (1 + np.linalg.solve(A, J.T @ (y - model)))
    model = _simulated(u, p)
    rest = y - model
    blocks = len(y) // 100
    r = np.einsum(
        "bki,bk->bi", J[: 100 * blocks].reshape(blocks, 100, 5), rest[: 100 * blocks].reshape(blocks, 100)
    )
    C = np.linalg.inv(A)
    C = C @ (r.T @ r) @ C  # sandwich: the residuals' own correlation within blocks
    lag = p[3] + p[4]
    g = np.array([0, 0, 0, p[3] / lag, p[4] / lag])
    half = 2.2 * np.sqrt([*np.diag(C), g @ C @ g]) + 0.002
    return {
        k: [x, x * (1 - w), x * (1 + w)]
        for k, x, w in zip((*NAMES, "lag"), [*p.tolist(), float(lag)], half.tolist())
    }
