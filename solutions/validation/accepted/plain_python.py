"""No numpy at all: sums, loops and lists throughout."""


def rmse(e):
    return math.sqrt(math.fsum(float(x) * float(x) for x in e) / len(e))


def bias_variance(e):
    bias = math.fsum(float(x) for x in e) / len(e)
    return [bias, math.fsum((float(x) - bias) ** 2 for x in e) / len(e)]


def wrap_angle(e):
    return [math.remainder(float(x), 2 * math.pi) for x in e]  # IEEE: to the nearest whole turn


def coverage(y, lo, hi):
    inside = [a <= x <= b for x, a, b in zip(y, lo, hi)]
    return inside.count(True) / len(inside)


def energy_error(q, v, energy):
    first = energy(q[0], v[0])
    return [(energy(list(a), list(b)) - first) / abs(first) for a, b in zip(q, v)]


def contact_force_error(f_sim, f_real, dt):
    peak, impulse = max(f_real), math.fsum(f_real)  # dt cancels
    return {"impulse": math.fsum(f_sim) / impulse - 1, "peak": float(max(f_sim) / peak - 1)}


def block_bootstrap_ci(e, statistic, block, n_boot, alpha, rng):
    e = [float(x) for x in e]
    values = []
    for _ in range(n_boot):
        samples = []
        while len(samples) < len(e):
            start = int(rng.random() * (len(e) - block + 1))
            samples += e[start : start + block]
        values.append(statistic(samples[: len(e)]))
    values.sort()
    return values[int(alpha / 2 * n_boot)], values[min(n_boot - 1, int((1 - alpha / 2) * n_boot))]
