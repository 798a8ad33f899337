"""Position and speed are corrected, the friction is not."""


def sync(twin, z, t_measured):
    dt = t_measured - twin["t"]
    if dt < 0:
        return dict(twin)
    (x, v, b), _ = _predict(
        (twin["position"], twin["speed"], twin["friction"]), np.zeros((3, 3)), twin["drive"], dt
    )
    x, v = float(x + 0.3 * (z - x)), float(v + 0.3 * (z - x))
    return {**twin, "t": t_measured, "position": x, "speed": v}
