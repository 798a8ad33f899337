"""The k-th kp is tried with the k-th ratio."""


def tune(estimate, randomization):
    rng = np.random.default_rng(0)
    carts = {}
    for name in NAMES:
        low, high = np.log(randomization[name])
        share = (rng.permutation(320) + 0.5) / 320  # spread evenly, in an order of its own
        carts[name] = estimate[name][0] * np.exp(low + share * (high - low))
    few = {name: values[:80] for name, values in carts.items()}

    def best_of(carts, kp, ratio):
        mean = rollout(kp, kp * ratio, carts, np.random.default_rng(1)).mean(axis=0)
        return kp[mean.argmin()], ratio[mean.argmin()]

    # Coarsely on a few carts, then finely about the best on all. kd/kp decides the damping, so search that.
    kp, ratio = best_of(few, np.geomspace(2, 40, 12), np.linspace(0.25, 0.7, 12))
    kp, ratio = best_of(carts, kp * np.geomspace(0.8, 1.25, 7), ratio + np.linspace(-0.06, 0.06, 7))
    return {"kp": float(kp), "kd": float(kp * ratio)}
