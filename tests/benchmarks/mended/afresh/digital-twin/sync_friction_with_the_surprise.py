"""The friction is moved with the surprise, whichever way the cart goes."""


def sync(twin, z, t_measured):
    new = dict(twin)
    new["memory"] = dict(twin["memory"])
    dt = t_measured - twin["t"]
    if dt < 0:
        return new
    c, d = twin["friction"], twin["drive"]
    x, v = twin["position"], twin["speed"]
    a = d - c * v
    x = x + v * dt + a * dt**2 / 2
    v = v + a * dt
    surprise = z - x
    new["position"] = x + 0.3 * surprise
    new["speed"] = v + 0.4 * surprise
    new["friction"] = c + 0.15 * surprise
    new["t"] = t_measured
    return new
