"""The right path, with times that begin at h."""


def simulate_head_on(m, x0, v0, radius, restitution, t_end, h):
    n = round(t_end / h)
    t, x, v = h * np.arange(1, n + 2), np.empty((n + 1, 2)), np.empty((n + 1, 2))
    x[0], v[0] = x0, v0
    for i in range(n):
        (xa, xb), (va, vb) = x[i], v[i]
        c, gap = va - vb, max(xb - xa - 2 * radius, 0.0)
        w = gap / c if 0 < c and gap <= c * h else h
        xa, xb = xa + va * w, xb + vb * w
        if w < h:
            J = (1 + restitution) * c / (1 / m[0] + 1 / m[1])
            va, vb = va - J / m[0], vb + J / m[1]
        x[i + 1] = xa + va * (h - w), xb + vb * (h - w)
        v[i + 1] = va, vb
    return t, x, v
