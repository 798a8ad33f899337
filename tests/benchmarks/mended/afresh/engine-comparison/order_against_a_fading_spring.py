"""The order, against a spring that fades and swings at the undamped frequency."""


def _order(engine, omega):
    c = _linear_damping(engine, engine.info()["dt"])
    T = 1.3 / omega
    # the exact motion of a damped spring from (1, 0.7 omega)
    fade = math.exp(-c * T / 2)
    A, B = 1.0, (0.7 * omega + c / 2) / omega
    q_end = fade * (A * math.cos(omega * T) + B * math.sin(omega * T))

    def error(n):
        q, _ = engine.run("spring", [1.0], [0.7 * omega], T / n, n, [0.0])
        return abs(q[-1][0] - q_end)

    return round(math.log2(error(32) / error(64)))
