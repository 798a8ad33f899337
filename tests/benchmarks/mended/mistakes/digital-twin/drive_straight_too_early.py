# Turns below a hundredth of a radian are driven as straight lines.


def diff_drive_step(pose, v_left, v_right, track, dt):
    x, y, heading = pose
    v = (v_left + v_right) / 2
    rate = (v_right - v_left) / track
    turn = rate * dt
    if abs(turn) < 0.01:
        return np.array([x + v * dt * math.cos(heading), y + v * dt * math.sin(heading), heading + turn])
    chord = v * dt * math.sin(turn / 2) / (turn / 2)
    middle = heading + turn / 2
    return np.array([x + chord * math.cos(middle), y + chord * math.sin(middle), heading + turn])
