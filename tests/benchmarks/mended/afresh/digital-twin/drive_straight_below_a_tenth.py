"""The chord of a turn below 0.1 rad is taken to be as long as the arc."""


def diff_drive_step(pose, v_left, v_right, track, dt):
    x, y, heading = pose
    chord = (v_left + v_right) / 2 * dt
    turn = dt * (v_right - v_left) / track
    if abs(turn) > 0.1:
        chord *= math.sin(turn / 2) / (turn / 2)
    middle = heading + turn / 2
    return np.array([x + chord * math.cos(middle), y + chord * math.sin(middle), heading + turn])
