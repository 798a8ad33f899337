"""Arcs by the chord; turns below 0.005 rad use the whole arc along its middle heading."""


def diff_drive_step(pose, v_left, v_right, track, dt):
    x, y, heading = pose
    turn, way = (v_right - v_left) / track * dt, (v_left + v_right) / 2 * dt
    if abs(turn) > 0.005:
        way *= math.sin(turn / 2) / (turn / 2)  # left out below: 1e-6 of the way
    middle = heading + turn / 2
    return (x + way * math.cos(middle), y + way * math.sin(middle), heading + turn)
