"""The friction is corrected with the wrong sign."""


def sync(twin, z, t_measured):
    dt = t_measured - twin["t"]
    if dt < 0:
        return dict(twin)
    (x, v, b), _ = _predict(
        (twin["position"], twin["speed"], twin["friction"]), np.zeros((3, 3)), twin["drive"], dt
    )
    surprise = float(z - x)
    b = min(max(float(b) + 0.15 * surprise, 0.05), 5.0)
    x, v = float(x) + 0.3 * surprise, float(v) + 0.3 * surprise
    return {**twin, "t": t_measured, "position": x, "speed": v, "friction": b}
