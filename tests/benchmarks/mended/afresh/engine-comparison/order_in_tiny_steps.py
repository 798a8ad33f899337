"""The step for order is so tiny (5000, 10000 and 20000 steps) that rounding hides the error of an accurate
method, so the order of a third- or fourth-order engine comes out wrong.
"""

import math

import numpy as np


class Bench:
    """Everything that can be asked of one engine."""

    def __init__(self, engine):
        self.engine = engine
        for name, value in engine.info().items():
            setattr(self, name, value)

    def go(self, scene, q0, v0, h, n, force=None):
        q0 = np.atleast_1d(np.asarray(q0, float))
        v0 = np.atleast_1d(np.asarray(v0, float))
        force = np.zeros(q0.size) if force is None else np.asarray(force, float)
        q, v = self.engine.run(scene, q0.tolist(), v0.tolist(), float(h), int(n), force.tolist())
        return np.array(q, float), np.array(v, float)

    def matrix(self, h):
        m = np.empty((2, 2))
        for col, (a, b) in enumerate(((1.0, 0.0), (0.0, 1.0))):
            q, v = self.go("spring", a, b * self.omega, h, 1)
            m[:, col] = q[1, 0], v[1, 0] / self.omega
        return m

    def order(self):
        total = 1.7 / self.omega
        ends = []
        for n in (5000, 10000, 20000):
            q, v = self.go("spring", 0.8, 0.5 * self.omega, total / n, n)
            ends.append(np.array([q[-1, 0], v[-1, 0] / self.omega]))
        coarse = np.linalg.norm(ends[0] - ends[1])
        fine = np.linalg.norm(ends[1] - ends[2])
        return int(np.rint(np.log2(coarse / fine)))

    def symplectic(self):
        m = self.matrix(0.5 / self.omega)
        det = m[0, 0] * m[1, 1] - m[0, 1] * m[1, 0]
        return bool(abs(det - 1) < 1e-6)

    def linear_damping(self):
        h, n = self.dt / 2000, 200
        q, v = self.go("free", 0.0, 1.0, h, n)
        c = -math.log(v[-1, 0] / v[0, 0]) / (h * n)
        return c if c > 1e-5 else 0.0

    def is_stable(self, x):
        return np.abs(np.linalg.eigvals(self.matrix(x / self.omega))).max() <= 1 + 1e-8

    def max_stable_step(self):
        grid = np.linspace(0.05, 9.999, 41)
        flags = [self.is_stable(x) for x in grid]
        if all(flags):
            return math.inf
        first = flags.index(False)
        if first == 0:
            return 0.0
        a, b = grid[first - 1], grid[first]
        for _ in range(14):
            c = (a + b) / 2
            a, b = (c, b) if self.is_stable(c) else (a, c)
        return float(a / self.omega)

    def settle(self):
        q, v = self.go("floor", [0, 0, self.radius], [0, 0, 0], self.dt, round(5 / self.dt))
        return q[-1], v[-1]

    def least_force(self, angle):
        q0, v0 = self.settle()
        unit = np.array([math.cos(angle), math.sin(angle), 0.0])
        steps = round(0.5 / self.dt)
        low, high = 0.0, 5.0 * self.mu * self.mass * self.g
        while high - low > 1e-3 * high:
            f = (low + high) / 2
            q, v = self.go("floor", q0, v0, self.dt, steps, f * unit)
            speed = np.linalg.norm(v[:, :2], axis=1)
            if np.any(speed > 0.01):
                high = f
            else:
                low = f
        return (low + high) / 2

    def friction_anisotropy(self):
        return self.least_force(math.pi / 4) / self.least_force(0.0)

    def rest_penetration(self):
        q, v = self.settle()
        return float(max(0.0, self.radius - q[2]))

    def restitution(self):
        edge = -(self.radius + self.wall_thickness / 2)
        for shift in np.linspace(0, 1, 20, endpoint=False):
            x = edge - 2.0 * self.dt * (1.5 + shift)
            q, v = self.go("wall", x, 2.0, self.dt, round(0.4 / self.dt) + 10)
            back = np.flatnonzero(v[:, 0] <= 0)
            if back.size:
                k = back[0]
                return float(-v[k, 0] / v[k - 1, 0]) + 0.0
        return None

    def leaks(self, speed):
        travel = 2.0 + speed * self.dt
        n = min(20000, int(travel / (speed * self.dt)) + 3)
        offsets = np.linspace(0.0, speed * self.dt, 50)
        ends = [self.go("wall", -1.0 - s, speed, self.dt, n)[0][-1, 0] for s in offsets]
        return max(ends) > 0

    def tunnelling_speed(self):
        if not self.leaks(199.9):
            return math.inf
        low, high = 0.0, 199.9
        for _ in range(60):
            if high - low < 0.004 * high:
                break
            mid = (low + high) / 2
            if self.leaks(mid):
                high = mid
            else:
                low = mid
        return low

    def deterministic(self):
        a = self.go("spring", 0.9, 0.3 * self.omega, self.dt, 60)
        for _ in range(3):
            b = self.go("spring", 0.9, 0.3 * self.omega, self.dt, 60)
            if not (np.array_equal(a[0], b[0]) and np.array_equal(a[1], b[1])):
                return False
        return True


def characterise(engine):
    bench = Bench(engine)
    report = {}
    for key in (
        "order",
        "symplectic",
        "linear_damping",
        "max_stable_step",
        "friction_anisotropy",
        "rest_penetration",
        "restitution",
        "tunnelling_speed",
        "deterministic",
    ):
        try:
            report[key] = getattr(bench, key)()
        except Exception:
            report[key] = None
    return report
