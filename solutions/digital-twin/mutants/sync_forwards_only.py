"""The friction is corrected with one sign, whichever way the cart rolls."""


def sync(twin, z, t_measured):
    dt = t_measured - twin["t"]
    if dt < 0:
        return dict(twin)
    x, v, b = twin["position"], twin["speed"], twin["friction"]
    a = twin["drive"] - b * v
    x, v = x + dt * v + dt * dt / 2 * a, v + dt * a
    surprise = z - x
    x, v, b = x + 0.3 * surprise, v + 0.3 * surprise, min(max(b - 0.15 * surprise, 0.05), 5.0)
    return {**twin, "t": t_measured, "position": x, "speed": v, "friction": b, "memory": {}}
