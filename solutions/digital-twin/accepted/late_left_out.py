"""A Kalman filter in plain numbers that ignores late measurements and keeps only its covariance."""


def sync(twin, z, t_measured):
    dt = t_measured - twin["t"]
    if dt < 0:
        return {**twin, "memory": dict(twin["memory"])}
    x, v, b, d = (twin[key] for key in ("position", "speed", "friction", "drive"))
    P = twin["memory"].get("P", [[0.01, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1]])
    f = math.exp(-b * dt)
    r = (1 - f) / b
    x, v, F = (
        x + v * r + d * (dt - r) / b,
        v * f + d * r,
        [[1, r, -v * dt**2 / 2], [0, f, -v * dt], [0, 0, 1]],
    )
    FP = [[sum(F[i][k] * P[k][j] for k in range(3)) for j in range(3)] for i in range(3)]
    P = [[sum(FP[i][k] * F[j][k] for k in range(3)) for j in range(3)] for i in range(3)]
    P[1][1] += 1e-5 * dt
    P[2][2] += 0.003 * dt
    s = P[0][0] + twin["sigma"] ** 2
    K = [P[i][0] / s for i in range(3)]
    x, v, b = (value + k * (z - x) for value, k in zip((x, v, b), K))
    P = [[P[i][j] - K[i] * P[0][j] for j in range(3)] for i in range(3)]
    return {**twin, "t": t_measured, "position": x, "speed": v, "friction": max(b, 0.05), "memory": {"P": P}}
