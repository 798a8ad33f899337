"""The data sheet's friction is kept; position and speed are corrected."""


def sync(twin, z, t_measured):
    dt = t_measured - twin["t"]
    result = {**twin, "memory": {}}
    if dt <= 0:
        return result
    a = twin["drive"] - twin["friction"] * twin["speed"]
    position = twin["position"] + twin["speed"] * dt + 0.5 * a * dt * dt
    speed = twin["speed"] + a * dt
    late = z - position
    result.update(t=t_measured, position=position + 0.35 * late, speed=speed + 0.6 * late)
    return result
