"""The speed at the floor is sqrt(v² + g (z - radius)): the 2 is missing."""


def simulate_drop(z0, v0, radius, restitution, g, t_end, h):
    n = round(t_end / h)
    t, z, v = h * np.arange(n + 1), np.empty(n + 1), np.empty(n + 1)
    z[0], v[0] = z0, v0
    resting = False
    for i in range(n):
        z[i + 1], v[i + 1] = z[i] + v[i] * h - g * h * h / 2, v[i] - g * h
        if resting:
            z[i + 1], v[i + 1] = radius, 0.0
        elif z[i + 1] < radius:  # a parabola that starts above the floor crosses it once
            speed = math.sqrt(v[i] ** 2 + g * max(z[i] - radius, 0.0))
            left = h - (v[i] + speed) / g
            up = restitution * speed
            resting = up <= g * h
            z[i + 1] = radius + (0.0 if resting else up * left - g * left * left / 2)
            v[i + 1] = 0.0 if resting else up - g * left
    return t, z, v
