"""A grid of kp that ends far too low."""


def tune(estimate, randomization):
    rng = np.random.default_rng(2)
    carts = {k: estimate[k][0] * np.exp(rng.uniform(*np.log(randomization[k]), 60)) for k in NAMES}
    kp, ratio = (x.ravel() for x in np.meshgrid(np.geomspace(0.5, 3.5, 8), np.linspace(0.25, 0.8, 6)))
    cost = rollout(kp, kp * ratio, carts, np.random.default_rng(1)).mean(axis=0)
    return {"kp": float(kp[cost.argmin()]), "kd": float((kp * ratio)[cost.argmin()])}
