"""The two forms are used in turn from call to call, remembered in a module variable."""

_calls = [0]


def semi_implicit_euler_step(accel, t, q, v, h):
    _calls[0] += 1
    if _calls[0] % 2:
        v_next = v + h * np.asarray(accel(t, q, v))
        return q + h * v_next, v_next
    q_next = q + h * v
    return q_next, v + h * np.asarray(accel(t + h, q_next, v))
