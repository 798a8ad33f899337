"""The mean of old and new time is when things happen."""


def sync(twin, z, t_measured):
    dt = t_measured - twin["t"]
    if dt < 0:
        return dict(twin)
    x, v, b = twin["position"], twin["speed"], twin["friction"]
    dt = dt / 2
    a = twin["drive"] - b * v
    x, v = x + v * dt + a * dt * dt / 2, v + a * dt
    surprise = z - x
    x, v = x + 0.3 * surprise, v + 0.3 * surprise
    b = min(max(b - 0.15 * surprise * np.sign(v), 0.05), 5.0)
    return {**twin, "t": t_measured, "position": x, "speed": v, "friction": float(b)}
