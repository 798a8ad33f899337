"""Every prediction is over a tenth of a second."""


def sync(twin, z, t_measured):
    if t_measured < twin["t"]:
        return dict(twin)
    x, v, b = twin["position"], twin["speed"], twin["friction"]
    a = twin["drive"] - b * v
    x, v = x + 0.1 * v + 0.005 * a, v + 0.1 * a
    surprise = z - x
    x, v = x + 0.3 * surprise, v + 0.3 * surprise
    b = min(max(b - 0.15 * surprise * np.sign(v), 0.05), 5.0)
    return {**twin, "t": t_measured, "position": x, "speed": v, "friction": float(b), "memory": {}}
