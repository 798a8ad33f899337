"""Unusual: no numpy at all; eigenvalues from trace and determinant, damping by extrapolation."""


def _spring_step(engine, omega, z):
    first = engine.run("spring", (1,), (0,), z / omega, 1, (0,))
    second = engine.run("spring", (0,), (omega,), z / omega, 1, (0,))
    (a, c), (b, d) = [(float(q[1][0]), float(v[1][0]) / omega) for q, v in (first, second)]
    return a, b, c, d


def _radius(engine, omega, z):
    a, b, c, d = _spring_step(engine, omega, z)
    half, det = (a + d) / 2, a * d - b * c
    root = half * half - det
    return math.sqrt(det) if root < 0 else abs(half) + math.sqrt(root)


def _max_stable_z(engine, omega):
    grid = [0.05 + 0.25 * k for k in range(40)]
    unstable = [z for z in grid if _radius(engine, omega, z) > 1 + 1e-8]
    if not unstable:
        return math.inf
    if unstable[0] == grid[0]:
        return 0.0
    low, high = unstable[0] - 0.25, unstable[0]
    while high - low > 0.003:
        middle = (low + high) / 2
        if _radius(engine, omega, middle) > 1 + 1e-8:
            high = middle
        else:
            low = middle
    return (low + high) / 2


def _linear_damping(engine, dt):
    def rate(h):
        _, v = engine.run("free", [0.0], [3.0], h, 1, [0.0])
        return -math.log(float(v[1][0]) / 3.0) / h

    return 2 * rate(dt / 64) - rate(dt / 32)


def _deterministic(engine, dt):
    def numbers():
        q, v = engine.run("wall", [-1.0], [1.5], dt, 40, [0.1])
        return [float(x[0]) for x in q] + [float(x[0]) for x in v]

    return numbers() == numbers()


def characterise(engine):
    info = engine.info()
    a, b, c, d = _spring_step(engine, info["omega"], 0.5)
    return {
        "deterministic": _deterministic(engine, info["dt"]),
        "tunnelling_speed": _tunnelling_speed(engine, info),
        "restitution": _slow_hit(engine, info)[0],
        "rest_penetration": max(0.0, info["radius"] - float(_settled(engine, info)[2])),
        "friction_anisotropy": _anisotropy(engine, info),
        "max_stable_step": _max_stable_z(engine, info["omega"]) / info["omega"],
        "linear_damping": _linear_damping(engine, info["dt"]),
        "symplectic": abs(a * d - b * c - 1) < 1e-6,
        "order": _order(engine, info["omega"]),
    }
