"""The acceleration is a number: float() of its first component, for all directions."""


def semi_implicit_euler_step(accel, t, q, v, h):
    a = float(accel(t, q, v)[0])
    v_new = [vi + h * a for vi in v]
    q_new = [qi + h * wi for qi, wi in zip(q, v_new)]
    return np.array(q_new), np.array(v_new)
