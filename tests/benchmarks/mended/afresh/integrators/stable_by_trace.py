"""A 2 by 2 map is stable while its trace is at most two."""


def max_stable_step(step, omega):
    def accel(t, q, v):
        return -(omega**2) * q

    def stable(h):
        q1, v1 = step(accel, 0.0, np.array([1.0]), np.array([0.0]), h)
        q2, v2 = step(accel, 0.0, np.array([0.0]), np.array([omega]), h)
        return abs(q1[0] + v2[0] / omega) <= 2 + 1e-8

    z = 0.05
    if not stable(z / omega):
        return 0.0
    while stable((z + 0.01) / omega):
        z += 0.01
        if z > 10:
            return math.inf
    return z / omega
