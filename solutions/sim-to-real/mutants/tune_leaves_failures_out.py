"""A cart that does not settle has no settling time."""


def tune(estimate, randomization):
    rng = np.random.default_rng(0)
    box = {name: np.log(randomization[name]) for name in NAMES}
    carts = {name: estimate[name][0] * np.exp(rng.uniform(*box[name], 200)) for name in NAMES}
    kp, ratio = (x.ravel() for x in np.meshgrid(np.geomspace(2, 40, 16), np.linspace(0.2, 0.75, 12)))
    times = rollout(kp, kp * ratio, carts, np.random.default_rng(1))
    never = times >= 3.0
    settled = np.where(never, 0.0, times).sum(axis=0) / np.maximum(np.sum(~never, axis=0), 1)
    i = np.argmin(np.where(never.all(axis=0), 3.0, settled))
    return {"kp": float(kp[i]), "kd": float(kp[i] * ratio[i])}
