"""From rest, the first half kick is left out."""


def velocity_verlet_step(accel, t, q, v, h):
    q, half = np.array(q, dtype=float), np.array(v, dtype=float)
    if np.any(half):
        half = half + h / 2 * np.asarray(accel(t, q, half))
    q_next = q + h * half
    return q_next, half + h / 2 * np.asarray(accel(t + h, q_next, half))
