"""A mass on a spring, moved by explicit Euler."""


def trajectory(stretch, rate, h, n):
    """Positions (m) and velocities (m/s), the start and n steps of h seconds."""
    x, v = stretch, 0.0
    xs, vs = [x], [v]
    for _ in range(n):
        v_next = v - h * rate**2 * x
        x = x + h * v_next
        v = v_next
        xs.append(x)
        vs.append(v)
    return xs, vs
