"""x grows with the sine of the heading."""


def diff_drive_step(pose, v_left, v_right, track, dt):
    x, y, heading = pose
    turn = (v_right - v_left) / track * dt
    chord = (v_left + v_right) / 2 * dt * np.sinc(turn / (2 * math.pi))
    middle = heading + turn / 2
    return np.array([x + chord * math.sin(middle), y + chord * math.cos(middle), heading + turn])
