"""The norm of the matrix, instead of its eigenvalues, must stay below one."""


def max_stable_step(step, omega):
    def size(z):
        def accel(t, q, v):
            return -(omega**2) * q

        a, c = step(accel, 0.0, np.ones(1), np.zeros(1), z / omega)
        b, d = step(accel, 0.0, np.zeros(1), omega * np.ones(1), z / omega)
        matrix = np.array([[a[0], b[0]], [c[0] / omega, d[0] / omega]])
        return np.linalg.norm(matrix, 2)

    z = 0.05
    while size(z) <= 1 + 1e-8:
        z += 0.01
        if z >= 10:
            return math.inf
    return (z - 0.005) / omega if z > 0.05 else 0.0
