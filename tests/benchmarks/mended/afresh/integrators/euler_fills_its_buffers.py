"""The results live in module-level buffers that the next call overwrites, so earlier states change."""

_buffers = {}


def explicit_euler_step(accel, t, q, v, h):

    q_next, v_next = _buffers.setdefault(len(q), (np.zeros(len(q)), np.zeros(len(q))))
    a = np.array(accel(t, q, v), dtype=float)
    new_q, new_v = q + h * v, v + h * a
    q_next[:], v_next[:] = new_q, new_v
    return q_next, v_next
