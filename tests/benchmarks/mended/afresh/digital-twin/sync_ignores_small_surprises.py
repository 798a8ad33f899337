"""What may be noise is no surprise."""


def sync(twin, z, t_measured):
    dt = t_measured - twin["t"]
    if dt < 0:
        return dict(twin)
    x, v, b = twin["position"], twin["speed"], twin["friction"]
    a = twin["drive"] - b * v
    x, v = x + v * dt + a * dt * dt / 2, v + a * dt
    surprise = z - x
    if abs(surprise) < 3 * twin["sigma"]:
        surprise = 0.0
    x, v = x + 0.3 * surprise, v + 0.3 * surprise
    b = min(max(b - 0.15 * surprise * np.sign(v), 0.05), 5.0)
    return {**twin, "t": t_measured, "position": x, "speed": v, "friction": float(b)}
