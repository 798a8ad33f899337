"""The lowest point of the parabola lies towards the larger neighbour."""


def best_shift(pairs):
    dt = min(r["t"][1] - r["t"][0] for _, r in pairs)
    shifts = np.arange(-round(MAX_LAG / dt), round(MAX_LAG / dt) + 1) * dt
    cost = misfit(pairs, shifts)
    i = int(np.clip(np.argmin(cost), 1, len(cost) - 2))
    a, b, c = cost[i - 1 : i + 2]
    return float(shifts[i] - 0.5 * dt * (a - c) / (a - 2 * b + c))
