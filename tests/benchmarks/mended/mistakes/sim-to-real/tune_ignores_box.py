# Tuned for the estimate alone.


def tune(estimate, randomization):
    carts = {}
    for name in NAMES:
        carts[name] = np.full(320, estimate[name][0])
    few = {name: values[:80] for name, values in carts.items()}

    def best_of(carts, kp, ratio):
        kp, ratio = (x.ravel() for x in np.meshgrid(kp, ratio))
        mean = rollout(kp, kp * ratio, carts, np.random.default_rng(1)).mean(axis=0)
        return kp[mean.argmin()], ratio[mean.argmin()]

    # Coarsely on a few carts, then finely about the best on all. kd/kp decides the damping, so search that.
    kp, ratio = best_of(few, np.geomspace(2, 40, 12), np.linspace(0.25, 0.7, 8))
    kp, ratio = best_of(carts, kp * np.geomspace(0.8, 1.25, 7), ratio + np.linspace(-0.06, 0.06, 7))
    return {"kp": float(kp), "kd": float(kp * ratio)}
