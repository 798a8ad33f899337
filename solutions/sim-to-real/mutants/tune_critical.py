"""kd is that of critical damping for the mass alone."""


def tune(estimate, randomization):
    rng = np.random.default_rng(0)
    carts = {k: estimate[k][0] * np.exp(rng.uniform(*np.log(randomization[k]), 60)) for k in NAMES}
    kp = np.geomspace(1, 40, 30)
    kd = 2 * np.sqrt(kp * estimate["m"][0]) - estimate["b"][0]
    i = rollout(kp, kd, carts, np.random.default_rng(1)).mean(axis=0).argmin()
    return {"kp": float(kp[i]), "kd": float(kd[i])}
