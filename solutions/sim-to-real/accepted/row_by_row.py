"""One call of rollout per kp, random draws, and plain Python to compare."""


def tune(estimate, randomization):
    rng = np.random.default_rng(8)
    carts = {k: estimate[k][0] * np.exp(rng.uniform(*np.log(randomization[k]), 300)) for k in NAMES}
    few = {k: x[:70] for k, x in carts.items()}

    def best_of(carts, kps, ratios):
        found = []
        for kp in kps:
            settling = rollout(np.full(len(ratios), kp), kp * ratios, carts, np.random.default_rng(1))
            found += [
                (mean, kp, ratio) for mean, ratio in zip(settling.mean(axis=0).tolist(), ratios.tolist())
            ]
        return min(found)

    _, kp, ratio = best_of(few, np.geomspace(3, 36, 13), np.linspace(0.25, 0.75, 9))
    _, kp, ratio = best_of(carts, kp * np.geomspace(0.82, 1.22, 7), ratio + np.linspace(-0.06, 0.06, 7))
    return {"kp": float(kp), "kd": float(kp * ratio)}
