"""Constant shares, and nine tenths of the surprise for the position."""


def sync(twin, z, t_measured):
    dt = t_measured - twin["t"]
    if dt < 0:
        return dict(twin)
    x, v, b = twin["position"], twin["speed"], twin["friction"]
    a = twin["drive"] - b * v
    x, v = x + dt * v + dt * dt / 2 * a, v + dt * a
    surprise = z - x
    x, v = x + 0.9 * surprise, v + 0.3 * surprise
    b = min(max(b - 0.15 * surprise * np.sign(v), 0.05), 5.0)
    return {**twin, "t": t_measured, "position": x, "speed": v, "friction": float(b), "memory": {}}
