"""Latency and tau are left out of the randomization: all carts have the estimated values, also for boxes
shifted towards other delays.
"""

import numpy as np

ORDER = ("m", "b", "Fc", "tau", "latency")


def drawn(estimate, box, count):
    gen = np.random.default_rng(42)
    carts = {}
    for name in ORDER:
        low, high = box[name] if name in ("m", "b", "Fc") else (1.0, 1.0)
        carts[name] = estimate[name][0] * np.exp(gen.uniform(np.log(low), np.log(high), count))
    return carts


def tune(estimate, randomization):
    carts = drawn(estimate, randomization, 300)

    def cost(kp, kd, count=300):
        some = {name: x[:count] for name, x in carts.items()}
        times = rollout(kp, kd, some, np.random.default_rng(7))
        return np.mean(times, axis=0)

    kp_axis = np.linspace(1.0, 25.0, 25)
    kd_axis = np.linspace(0.5, 16.0, 26)
    kp, kd = np.meshgrid(kp_axis, kd_axis, indexing="ij")
    kp, kd = kp.ravel(), kd.ravel()
    k = np.argmin(cost(kp, kd, 100))
    near_p = kp[k] + np.linspace(-1.2, 1.2, 9)
    near_d = kd[k] + np.linspace(-1.0, 1.0, 9)
    fine_p, fine_d = np.meshgrid(np.clip(near_p, 0.1, None), np.clip(near_d, 0.0, None), indexing="ij")
    fine_p, fine_d = fine_p.ravel(), fine_d.ravel()
    k = np.argmin(cost(fine_p, fine_d))
    return {"kp": float(fine_p[k]), "kd": float(fine_d[k])}
