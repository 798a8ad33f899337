"""The radius is used for every turn rate but zero."""


def diff_drive_step(pose, v_left, v_right, track, dt):
    x, y, heading = pose
    rate, speed = (v_right - v_left) / track, (v_left + v_right) / 2
    if rate == 0:
        return np.array([x + speed * dt * math.cos(heading), y + speed * dt * math.sin(heading), heading])
    end, radius = heading + rate * dt, speed / rate
    x += radius * (math.sin(end) - math.sin(heading))
    y -= radius * (math.cos(end) - math.cos(heading))
    return np.array([x, y, end])
