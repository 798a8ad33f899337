"""The heading is wrapped."""

_whole = diff_drive_step


def diff_drive_step(pose, v_left, v_right, track, dt):
    x, y, heading = _whole(pose, v_left, v_right, track, dt)
    return np.array([x, y, (heading + math.pi) % (2 * math.pi) - math.pi])
