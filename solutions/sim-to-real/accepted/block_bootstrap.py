"""Intervals from a bootstrap over blocks, refitting a whole grid of delays each time; no Newton step."""


def identify(t, u, y):
    rng = np.random.default_rng(3)
    friction = in_blocks(np.stack([cumulative(y), cumulative(np.sign(y))], axis=1), 50)
    v = in_blocks(y, 50)

    def grams(taus, lates):
        impulses = [motor_impulse(u, tau) for tau in taus]
        trials = np.stack([delayed(x, late) for x in impulses for late in lates], axis=1)
        Z = np.concatenate([in_blocks(trials, 50), friction, v], axis=2)
        n = trials.shape[1]
        pick = np.array([[j, n, n + 1, n + 2] for j in range(n)])
        G = Z.transpose(0, 2, 1) @ Z
        return G[:, pick[:, :, None], pick[:, None, :]], [(tau, late) for tau in taus for late in lates]

    def fits(G, weights):
        G = np.tensordot(weights, G, 1)
        theta = np.linalg.solve(G[..., :3, :3], G[..., :3, 3:])[..., 0]
        return theta, G[..., 3, 3] - np.sum(theta * G[..., :3, 3], axis=-1)

    G, where = grams(np.arange(0.02, 0.151, 0.02), np.arange(0.02, 0.201, 0.01))
    tau, late = where[int(fits(G, np.ones((1, len(v))))[1].argmin())]
    G, where = grams(
        np.clip(tau + np.arange(-0.02, 0.021, 0.004), 0.005, 1), late + np.arange(-0.02, 0.021, 0.002)
    )
    weights = np.concatenate([np.ones((1, len(v))), rng.multinomial(len(v), np.ones(len(v)) / len(v), 80)])
    theta, misfit = fits(G, weights)
    best = misfit.argmin(axis=1)
    theta = theta[np.arange(len(best)), best]
    tau, late = np.array(where)[best].T
    m = 1 / theta[:, 0]
    b, Fc = -theta[:, 1] * m, -theta[:, 2] * m
    rows = {"m": m, "b": b, "Fc": Fc, "tau": tau, "latency": late, "lag": tau + late}
    # The grid's own step is uncertain too.
    step = {"tau": 0.004, "latency": 0.002, "lag": 0.002}
    out = {}
    for name, x in rows.items():
        half = 2.1 * math.hypot(np.std(x[1:]), step.get(name, 0.0) / 3)
        out[name] = [float(x[0]), float(x[0] - half), float(x[0] + half)]
    return out
