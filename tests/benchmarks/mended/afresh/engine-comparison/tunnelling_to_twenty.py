"""Nothing is faster than 20 m/s."""


def _tunnelling_speed(engine, info):
    dt = info["dt"]

    def safe(speed):
        n = math.ceil(3 / (speed * dt)) + 2
        for k in range(40):
            q, _ = engine.run("wall", [-1 - speed * dt * k / 40], [speed], dt, n, [0])
            if q[-1][0] > 0:
                return False
        return True

    low, high = 0.5, 20.0
    if safe(high):
        return math.inf
    while high - low > 0.1:
        mid = (low + high) / 2
        low, high = (mid, high) if safe(mid) else (low, mid)
    return low
