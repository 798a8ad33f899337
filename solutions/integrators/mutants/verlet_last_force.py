"""The acceleration of the last call is used again if the times fit."""

_last = {}


def velocity_verlet_step(accel, t, q, v, h):
    known = _last and abs(_last["t"] - t) < 1e-9 and np.shape(_last["a"]) == np.shape(q)
    w = v + h / 2 * (_last["a"] if known else np.asarray(accel(t, q, v), dtype=float))
    q_next = q + h * w
    a_next = np.asarray(accel(t + h, q_next, w), dtype=float)
    _last.update(t=t + h, a=a_next)
    return q_next, w + h / 2 * a_next
