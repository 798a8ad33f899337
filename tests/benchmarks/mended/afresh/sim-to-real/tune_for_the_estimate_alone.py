"""The gains are tuned for the estimate alone: the box is ignored and all simulated carts are the same."""

import numpy as np


def tune(estimate, randomization):
    rng = np.random.default_rng(0)
    count = 300
    cart = {}
    for k in ("m", "b", "Fc", "tau", "latency"):
        low, high = 0.0, 0.0
        share = (rng.permutation(count) + 0.5) / count
        cart[k] = estimate[k][0] * np.exp(low + (high - low) * share)
    kps, kds = np.linspace(1, 23, 12), np.linspace(0.5, 14.8, 12)
    step_p, step_d = kps[1] - kps[0], kds[1] - kds[0]
    for _ in range(3):
        P, D = (g.ravel() for g in np.meshgrid(kps, kds))
        cost = rollout(P, D, cart, np.random.default_rng(1)).mean(axis=0)
        i = np.argmin(cost)
        kps = np.maximum(P[i] + step_p * np.linspace(-0.75, 0.75, 7), 0.05)
        kds = np.maximum(D[i] + step_d * np.linspace(-0.75, 0.75, 7), 0.0)
        step_p, step_d = step_p / 3, step_d / 3
    return {"kp": float(P[i]), "kd": float(D[i])}
