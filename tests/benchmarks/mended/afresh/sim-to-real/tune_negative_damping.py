"""kd is subtracted, so it is negative."""


def tune(estimate, randomization):
    rng = np.random.default_rng(0)
    carts = {}
    for name in NAMES:
        low, high = np.log(randomization[name])
        share = (rng.permutation(200) + 0.5) / 200  # spread evenly, in an order of its own
        carts[name] = estimate[name][0] * np.exp(low + share * (high - low))
    few = {name: values[:60] for name, values in carts.items()}

    def best_of(carts, kp, ratio):
        kp, ratio = (x.ravel() for x in np.meshgrid(kp, ratio))
        mean = rollout(kp, kp * ratio, carts, np.random.default_rng(1)).mean(axis=0)
        return kp[mean.argmin()], ratio[mean.argmin()]

    # Coarsely on a few carts, then finely about the best on all. kd/kp decides the damping, so search that.
    kp, ratio = best_of(few, np.geomspace(2, 40, 12), np.linspace(0.25, 0.7, 8))
    kp, ratio = best_of(carts, kp * np.geomspace(0.8, 1.25, 5), ratio + np.linspace(-0.06, 0.06, 5))
    return {"kp": float(kp), "kd": -float(kp * ratio)}
