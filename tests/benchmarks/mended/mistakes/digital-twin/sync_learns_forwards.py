# Friction is moved against the surprise going backwards too.


def sync(twin, z, t_measured):
    dt = t_measured - twin["t"]
    if dt < 0:
        return dict(twin)
    x, v, b = twin["position"], twin["speed"], twin["friction"]
    n = 50
    for _ in range(n):
        a = twin["drive"] - b * v
        x, v = x + v * dt / n, v + a * dt / n
    surprise = z - x
    x, v = x + 0.3 * surprise, v + 0.3 * surprise
    b = b - 0.15 * surprise
    return {**twin, "t": t_measured, "position": x, "speed": v, "friction": b}
