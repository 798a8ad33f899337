"""The reduced mass as a product over a sum, which an infinite mass turns into nan."""


def simulate_head_on(m, x0, v0, radius, restitution, t_end, h):
    n = round(t_end / h)
    t, x, v = h * np.arange(n + 1), np.empty((n + 1, 2)), np.empty((n + 1, 2))
    x[0], v[0] = x0, v0
    for i in range(n):
        (xa, xb), (va, vb) = x[i], v[i]
        closing, gap = va - vb, max(xb - xa - 2 * radius, 0.0)
        wait = gap / closing if 0 < closing and gap <= closing * h else h
        xa, xb = xa + va * wait, xb + vb * wait
        if wait < h:
            impulse = (1 + restitution) * closing * m[0] * m[1] / (m[0] + m[1])
            va, vb = va - impulse / m[0], vb + impulse / m[1]
        x[i + 1] = xa + va * (h - wait), xb + vb * (h - wait)
        v[i + 1] = va, vb
    return t, x, v
