"""A contact in the first step is not looked for."""

_right_head_on = simulate_head_on


def simulate_head_on(m, x0, v0, radius, restitution, t_end, h):
    gap, closing = x0[1] - x0[0] - 2 * radius, v0[0] - v0[1]
    t, x, v = _right_head_on(m, x0, v0, radius, restitution, t_end, h)
    if closing > 0 and gap <= closing * h:  # the impact that the first step skips is never made up for
        x, v = x0 + t[:, None] * v0, np.broadcast_to(v0, x.shape).copy()
    return t, x, v
