"""The results lie in arrays of the module, which the next call fills again."""

_right, _buffers = explicit_euler_step, {}


def explicit_euler_step(accel, t, q, v, h):
    result = _right(accel, t, q, v, h)
    kept = _buffers.setdefault(len(q), (np.zeros(len(q)), np.zeros(len(q))))
    kept[0][:], kept[1][:] = result
    return kept
