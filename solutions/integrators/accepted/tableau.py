"""All four steps from one table-driven routine."""


def _runge_kutta(a, b, c):
    def step(accel, t, q, v, h):
        y, slopes = np.stack([q, v]), []
        for row, node in zip(a, c):
            stage = y + h * sum((w * k for w, k in zip(row, slopes)), np.zeros(y.shape))
            slopes.append(np.stack([stage[1], accel(t + node * h, stage[0], stage[1])]))
        return tuple(y + h * sum(w * k for w, k in zip(b, slopes)))

    return step


explicit_euler_step = _runge_kutta([[]], [1], [0])
rk4_step = _runge_kutta([[], [0.5], [0, 0.5], [0, 0, 1]], [1 / 6, 1 / 3, 1 / 3, 1 / 6], [0, 0.5, 0.5, 1])


def _splitting(kicks, drifts):
    def step(accel, t, q, v, h):
        now = t
        for kick, drift in zip(kicks, drifts):
            if kick:
                v = v + kick * h * accel(now, q, v)
            q, now = q + drift * h * v, now + drift * h
        return q, v

    return step


semi_implicit_euler_step = _splitting([1], [1])
velocity_verlet_step = _splitting([1 / 2, 1 / 2], [1, 0])
