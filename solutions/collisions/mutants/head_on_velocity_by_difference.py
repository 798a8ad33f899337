"""Velocities are differences of neighbouring positions."""


def simulate_head_on(m, x0, v0, radius, restitution, t_end, h):
    n = round(t_end / h)
    t, x, v = h * np.arange(n + 1), np.empty((n + 1, 2)), np.empty((n + 1, 2))
    x[0], v[0] = x0, v0
    va, vb = v0
    for i in range(n):
        (xa, xb) = x[i]
        c, gap = va - vb, max(xb - xa - 2 * radius, 0.0)
        w = gap / c if 0 < c and gap <= c * h else h
        xa, xb = xa + va * w, xb + vb * w
        if w < h:
            J = (1 + restitution) * c / (1 / m[0] + 1 / m[1])
            va, vb = va - J / m[0], vb + J / m[1]
        x[i + 1] = xa + va * (h - w), xb + vb * (h - w)
        v[i + 1] = (x[i + 1] - x[i]) / h
    return t, x, v
