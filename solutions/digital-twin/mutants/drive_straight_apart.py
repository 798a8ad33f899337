"""In the case without a turn, dt is left out."""

_whole = diff_drive_step


def diff_drive_step(pose, v_left, v_right, track, dt):
    if v_left != v_right:
        return _whole(pose, v_left, v_right, track, dt)
    x, y, heading = pose
    return np.array([x + v_left * math.cos(heading), y + v_left * math.sin(heading), heading])
