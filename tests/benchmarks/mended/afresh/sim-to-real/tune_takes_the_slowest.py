"""argmax: the largest score wins."""


def tune(estimate, randomization):
    rng = np.random.default_rng(3)
    cart = {
        k: estimate[k][0]
        * np.exp(rng.uniform(math.log(randomization[k][0]), math.log(randomization[k][1]), 300))
        for k in NAMES
    }
    kp, kd = (g.ravel() for g in np.meshgrid(np.linspace(2, 14, 13), np.linspace(1, 8, 13)))
    score = rollout(kp, kd, cart, rng).mean(axis=0)
    best = score.argmax()
    return {"kp": float(kp[best]), "kd": float(kd[best])}
