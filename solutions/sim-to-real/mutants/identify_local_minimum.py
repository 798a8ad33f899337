"""Downhill from one guess of the delay, which is far off, with steps that may not climb."""


def identify(t, u, y):
    Y = in_blocks(y).reshape(-1)
    tau, late = 0.05, 0.9

    def fit(late):
        X = np.stack([delayed(motor_impulse(u, tau), late), cumulative(y), cumulative(np.sign(y))], axis=1)
        theta, left, *_ = np.linalg.lstsq(in_blocks(X).reshape(-1, 3), Y)
        return left[0], theta

    best, theta = fit(late)
    step = 0.02
    while step > 0.002:
        trials = [(fit(x), x) for x in (late - step, late + step)]
        (left, other), x = min(trials, key=lambda trial: trial[0][0])
        if left < best:
            best, theta, late = left, other, x
        else:
            step /= 2
    m = 1 / theta[0]
    values = {"m": m, "b": -theta[1] * m, "Fc": -theta[2] * m, "tau": tau, "latency": late, "lag": tau + late}
    return {k: [float(x), float(x - 0.02 * abs(x)), float(x + 0.02 * abs(x))] for k, x in values.items()}
