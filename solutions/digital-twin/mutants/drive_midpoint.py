"""The whole length of the arc is driven along the heading in the middle."""


def diff_drive_step(pose, v_left, v_right, track, dt):
    x, y, heading = pose
    way, turn = (v_left + v_right) / 2 * dt, (v_right - v_left) / track * dt
    middle = heading + turn / 2
    return np.array([x + way * math.cos(middle), y + way * math.sin(middle), heading + turn])
