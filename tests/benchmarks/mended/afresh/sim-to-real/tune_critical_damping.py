"""Critical damping is kd = 2 sqrt(kp m); kp alone is searched for."""


def tune(estimate, randomization):
    rng = np.random.default_rng(1)
    cart = {}
    for k in NAMES:
        a, b = np.log(randomization[k])
        cart[k] = estimate[k][0] * np.exp(rng.uniform(a, b, 300))
    kp = np.linspace(1, 20, 60)
    kd = 2 * np.sqrt(kp * estimate["m"][0])
    mean = rollout(kp, kd, cart, rng).mean(axis=0)
    i = int(mean.argmin())
    return {"kp": float(kp[i]), "kd": float(kd[i])}
