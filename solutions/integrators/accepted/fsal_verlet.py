"""Verlet that keeps the last acceleration: the end of one step is the start of the next (FSAL)."""

_last = {}


def velocity_verlet_step(accel, t, q, v, h):
    def acceleration(t, q, v):
        key = id(accel), float(t), q.tobytes()
        if _last.get("key") != key:
            _last.update(key=key, accel=accel, a=accel(t, q, v))  # holds accel, so that its id stays its own
        return _last["a"]

    v_half = v + h / 2 * acceleration(t, q, v)
    q_next = q + h * v_half
    return q_next, v_half + h / 2 * acceleration(t + h, q_next, v_half)
