"""Downhill from small gains in small steps, stopping at the first bump."""


def tune(estimate, randomization):
    rng = np.random.default_rng(0)
    carts = {k: estimate[k][0] * np.exp(rng.uniform(*np.log(randomization[k]), 60)) for k in NAMES}
    around = np.array([(1, 1), (1.05, 1), (1, 1.05), (0.95, 1), (1, 0.95)]).T

    kp, kd = 3.0, 3.0
    for _ in range(12):
        kps, kds = kp * around[0], kd * around[1]
        best = rollout(kps, kds, carts, np.random.default_rng(1)).mean(axis=0).argmin()
        if best == 0:
            break
        kp, kd = float(kps[best]), float(kds[best])
    return {"kp": kp, "kd": kd}
