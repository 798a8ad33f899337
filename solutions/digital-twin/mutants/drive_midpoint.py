"""The whole arc's length is gone along the middle heading."""


def diff_drive_step(pose, v_left, v_right, track, dt):
    x, y, heading = pose
    way, turn = (v_left + v_right) / 2 * dt, (v_right - v_left) / track * dt
    middle = heading + turn / 2
    return np.array([x + way * math.cos(middle), y + way * math.sin(middle), heading + turn])
