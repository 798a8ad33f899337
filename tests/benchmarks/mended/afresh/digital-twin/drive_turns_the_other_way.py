"""The faster left wheel turns it to the left."""


def diff_drive_step(pose, v_left, v_right, track, dt):
    x, y, heading = pose
    v = (v_left + v_right) / 2
    turn = (v_left - v_right) / track * dt
    factor = 1.0 if abs(turn) < 1e-9 else math.sin(turn / 2) / (turn / 2)
    chord = v * dt * factor
    return np.array(
        [
            x + chord * math.cos(heading + turn / 2),
            y + chord * math.sin(heading + turn / 2),
            heading + turn,
        ]
    )
