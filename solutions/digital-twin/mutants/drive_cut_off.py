"""Turns below 0.01 rad/s are treated as straight."""

_whole = diff_drive_step


def diff_drive_step(pose, v_left, v_right, track, dt):
    if abs(v_right - v_left) / track > 0.01:
        return _whole(pose, v_left, v_right, track, dt)
    x, y, heading = pose
    way = (v_left + v_right) / 2 * dt
    turn = (v_right - v_left) / track * dt
    return np.array([x + way * math.cos(heading), y + way * math.sin(heading), heading + turn])
