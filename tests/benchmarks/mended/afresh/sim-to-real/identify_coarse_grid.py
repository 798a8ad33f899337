"""A grid of five centiseconds is fine enough; nothing is refined."""


def identify(t, u, y):
    u, y = np.asarray(u, dtype=float), np.asarray(y, dtype=float)
    own = np.stack([cumulative(y), cumulative(np.sign(y))], axis=1)
    grid = [
        (a, b, delayed(motor_impulse(u, a), b)) for a in (0.02, 0.07, 0.12) for b in (0.02, 0.07, 0.12, 0.17)
    ]
    Y = in_blocks(y)
    n = len(Y)

    def search(keep):
        best = (math.inf,)
        for tau, late, column in grid:
            X = in_blocks(np.column_stack([column, own]))[keep].reshape(-1, 3)
            theta = np.linalg.lstsq(X, Y[keep].reshape(-1), rcond=None)[0]
            left = np.sum((Y[keep].reshape(-1) - X @ theta) ** 2)
            if left < best[0]:
                best = (left, tau, late, theta)
        _, tau, late, theta = best
        m = 1 / theta[0]
        return np.array([m, -theta[1] * m, -theta[2] * m, tau, late, tau + late])

    every = np.arange(n)
    values = search(every)
    refits = np.array([search(np.delete(every, i)) for i in range(n)])
    error = np.sqrt((n - 1) / n * np.sum((refits - refits.mean(axis=0)) ** 2, axis=0))
    names = ("m", "b", "Fc", "tau", "latency", "lag")
    return {k: [x, x - 2.1 * s, x + 2.1 * s] for k, x, s in zip(names, values.tolist(), error.tolist())}
