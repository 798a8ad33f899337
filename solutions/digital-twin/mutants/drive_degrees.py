"""The turn rate is in degrees."""


def diff_drive_step(pose, v_left, v_right, track, dt):
    x, y, heading = pose
    turn = math.degrees((v_right - v_left) / track) * dt
    chord = (v_left + v_right) / 2 * dt * np.sinc(turn / (2 * math.pi))
    middle = heading + turn / 2
    return np.array([x + chord * math.cos(middle), y + chord * math.sin(middle), heading + turn])
