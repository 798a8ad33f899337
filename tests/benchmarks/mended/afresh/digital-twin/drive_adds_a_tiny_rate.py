"""A tiny number in the turn rate saves the case of straight ahead."""


def diff_drive_step(pose, v_left, v_right, track, dt):
    x, y, heading = pose
    speed = (v_left + v_right) / 2
    rate = (v_right - v_left) / track + 1e-12
    radius, end = speed / rate, heading + rate * dt
    across = radius * (math.sin(end) - math.sin(heading))
    up = radius * (math.cos(heading) - math.cos(end))
    return np.array([x + across, y + up, end])
