"""Straight along the old heading, then the turn."""


def diff_drive_step(pose, v_left, v_right, track, dt):
    x, y, heading = pose
    way, turn = (v_left + v_right) / 2 * dt, (v_right - v_left) / track * dt
    return np.array([x + way * math.cos(heading), y + way * math.sin(heading), heading + turn])
