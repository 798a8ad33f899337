"""The directions before and after the turn are averaged."""


def diff_drive_step(pose, v_left, v_right, track, dt):
    x, y, heading = pose
    way, after = (v_left + v_right) / 2 * dt, heading + (v_right - v_left) / track * dt
    dx, dy = math.cos(heading) + math.cos(after), math.sin(heading) + math.sin(after)
    return np.array([x + way * dx / 2, y + way * dy / 2, after])
