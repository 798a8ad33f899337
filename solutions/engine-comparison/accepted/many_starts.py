"""Unusual: tunnelling by brute force, forty starts for each speed; nothing is assumed about the wall."""


def _tunnelling_speed(engine, info):
    dt = info["dt"]

    def stopped(speed):
        n = math.ceil(4 / (speed * dt)) + 3
        for k in range(40):
            start = -1 - speed * dt * k / 39
            q, _ = engine.run("wall", [start], [speed], dt, n, [0])
            if q[-1][0] > 0:
                return False
        return True

    if stopped(199.0):
        return math.inf
    low, high = 2.0, 199.0
    while high > 1.02 * low:
        middle = math.sqrt(low * high)
        low, high = (middle, high) if stopped(middle) else (low, middle)
    return low
