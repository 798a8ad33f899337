# The pose that was given is changed.


def diff_drive_step(pose, v_left, v_right, track, dt):
    turn = (v_right - v_left) / track * dt
    chord = (v_left + v_right) / 2 * dt * np.sinc(turn / (2 * math.pi))
    middle = pose[2] + turn / 2
    pose += np.array([chord * math.cos(middle), chord * math.sin(middle), turn])
    return pose
