# A late measurement corrects the twin as if it were new.


def sync(twin, z, t_measured):
    dt = t_measured - twin["t"]
    dt = max(dt, 0.0)
    x, v, b = twin["position"], twin["speed"], twin["friction"]
    n = 50
    for _ in range(n):
        a = twin["drive"] - b * v
        x, v = x + v * dt / n, v + a * dt / n
    surprise = z - x
    x, v = x + 0.3 * surprise, v + 0.3 * surprise
    b = b - 0.15 * surprise * np.sign(v)
    return {**twin, "t": max(twin["t"], t_measured), "position": x, "speed": v, "friction": b}
