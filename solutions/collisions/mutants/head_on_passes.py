"""The chapter's program with its samples corrected, and still without a collision."""


def simulate_head_on(m, x0, v0, radius, restitution, t_end, h):
    t = h * np.arange(round(t_end / h) + 1)
    v = np.tile(np.array(v0, float), (len(t), 1))
    return t, x0 + v * t[:, None], v
