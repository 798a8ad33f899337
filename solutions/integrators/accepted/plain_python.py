"""No numpy at all: lists and tuples instead of arrays."""


def _add(a, factor, b):
    return [float(x + factor * y) for x, y in zip(a, b)]


def explicit_euler_step(accel, t, q, v, h):
    a = accel(t, q, v)
    return _add(q, h, v), _add(v, h, a)


def semi_implicit_euler_step(accel, t, q, v, h):
    v = _add(v, h, accel(t, q, v))
    return [_add(q, h, v), v]


def velocity_verlet_step(accel, t, q, v, h):
    v = _add(v, h / 2, accel(t, q, v))
    q = _add(q, h, v)
    return tuple(q), tuple(_add(v, h / 2, accel(t + h, q, v)))


def rk4_step(accel, t, q, v, h):
    dq, dv = [0.0] * len(q), [0.0] * len(v)
    kq, kv = dq, dv
    for reach, weight in ((0, 1), (1 / 2, 2), (1 / 2, 2), (1, 1)):
        q_i, v_i = _add(q, reach * h, kq), _add(v, reach * h, kv)
        kq, kv = v_i, accel(t + reach * h, q_i, v_i)
        dq, dv = _add(dq, weight / 6, kq), _add(dv, weight / 6, kv)
    return _add(q, h, dq), _add(v, h, dv)


def integrate(step, accel, q0, v0, t_end, h):
    n = round(t_end / h)
    if abs(t_end / h - n) > 1e-6:
        raise ValueError("t_end is not a multiple of h")
    t, q, v = [0.0], [[float(x) for x in q0]], [[float(x) for x in v0]]
    for i in range(n):
        q_next, v_next = step(accel, i * h, np.array(q[-1]), np.array(v[-1]), h)
        t.append((i + 1) * h)
        q.append(list(q_next))
        v.append(list(v_next))
    return t, q, v


def observed_order(hs, errors):
    x, y = [math.log(h) for h in hs], [math.log(e) for e in errors]
    mx, my = sum(x) / len(x), sum(y) / len(y)
    return sum((a - mx) * (b - my) for a, b in zip(x, y)) / sum((a - mx) ** 2 for a in x)
