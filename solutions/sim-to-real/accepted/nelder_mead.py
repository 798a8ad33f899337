"""The Nelder-Mead simplex over the logarithms of kp and kd, after a coarse grid; 220 random draws."""


def tune(estimate, randomization):
    rng = np.random.default_rng(12)
    carts = {k: estimate[k][0] * np.exp(rng.uniform(*np.log(randomization[k]), 220)) for k in NAMES}

    def cost(z):
        kp, kd = np.exp(z)
        return float(rollout(kp, kd, carts, np.random.default_rng(5)).mean())

    kp, kd = (x.ravel() for x in np.meshgrid(np.geomspace(3, 40, 12), np.geomspace(1.5, 20, 12)))
    few = {k: x[:60] for k, x in carts.items()}
    k = rollout(kp, kd, few, np.random.default_rng(5)).mean(axis=0).argmin()
    z = np.log([kp[k], kd[k]])
    simplex = [(cost(p), tuple(p)) for p in (z, z + [0.2, 0.1], z + [0.0, 0.15])]
    for _ in range(11):
        simplex.sort()
        (_, a), (_, b), (worst, c) = simplex
        middle = (np.array(a) + b) / 2
        step = middle - c
        trials = [middle + step]
        value = cost(trials[0])
        if value < simplex[0][0]:
            trials.append(middle + 2 * step)
        elif value >= simplex[1][0]:
            trials.append(middle - step / 2)
        found = min([(value, tuple(trials[0]))] + [(cost(p), tuple(p)) for p in trials[1:]])
        if found[0] < worst:
            simplex[2] = found
        else:
            simplex = [simplex[0]] + [
                (cost(p), tuple(p)) for p in ((np.array(a) + b) / 2, (np.array(a) + c) / 2)
            ]
    kp, kd = np.exp(min(simplex)[1])
    return {"kp": float(kp), "kd": float(kd)}
