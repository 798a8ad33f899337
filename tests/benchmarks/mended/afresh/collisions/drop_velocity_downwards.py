"""The right path, with velocities that count downwards."""


def _dp(z0, v0, radius, e, g, t_end, h, up_of=None, left_of=None, rest=None, n=None, restz=None):
    n = round(t_end / h) if n is None else n
    t, z, v = h * np.arange(n + 1), np.empty(n + 1), np.empty(n + 1)
    z[0], v[0] = z0, v0
    resting = False
    for i in range(n):
        z[i + 1], v[i + 1] = z[i] + v[i] * h - g * h * h / 2, v[i] - g * h
        if resting:
            z[i + 1], v[i + 1] = radius, 0.0
        elif z[i + 1] < radius:
            s = math.sqrt(v[i] ** 2 + 2 * g * max(z[i] - radius, 0.0))
            left = h - (v[i] + s) / g
            up = e * s if up_of is None else up_of(e, s, v[i], g, h)
            if left_of:
                left = left_of(left, h)
            resting = up <= g * h if rest is None else rest(up, s, g, h)
            z[i + 1] = radius + (0.0 if resting else up * left - g * left * left / 2)
            v[i + 1] = 0.0 if resting else up - g * left
    return t, z, v


def simulate_drop(z0, v0, radius, restitution, g, t_end, h):
    t, z, v = _dp(z0, v0, radius, restitution, g, t_end, h)
    return t, z, -v
