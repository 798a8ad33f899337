"""The sum of the speeds turns the robot."""


def diff_drive_step(pose, v_left, v_right, track, dt):
    x, y, heading = pose
    turn = (v_right + v_left) / track * dt
    chord = (v_left + v_right) / 2 * dt * np.sinc(turn / (2 * math.pi))
    middle = heading + turn / 2
    return np.array([x + chord * math.cos(middle), y + chord * math.sin(middle), heading + turn])
