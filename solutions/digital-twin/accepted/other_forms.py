"""The lag as the remaining difference, play by if and else, arcs by their radius, a signal by weights."""


def motor_step(w, u, dt, tau, u_max, deadband):
    goal = float(np.clip(u, -u_max, u_max)) if abs(u) > deadband else 0
    return goal + (w - goal) * np.exp(-dt / tau)


def backlash(x, gap, state):
    if x - state > gap / 2:
        state = x - gap / 2
    elif state - x > gap / 2:
        state = x + gap / 2
    return [state, state]


def diff_drive_step(pose, v_left, v_right, track, dt):
    rate, speed = (v_right - v_left) / track, 0.5 * (v_right + v_left)
    if abs(rate) < 1e-7:  # less than a tenth of a micrometre at these speeds
        return pose + np.array([speed * np.cos(pose[2]), speed * np.sin(pose[2]), rate]) * dt
    radius, end = speed / rate, pose[2] + rate * dt
    centre = pose[:2] + radius * np.array([-np.sin(pose[2]), np.cos(pose[2])])
    return np.append(centre + radius * np.array([np.sin(end), -np.cos(end)]), end)


def delay_line(x, dt, latency):
    whole, part = int(latency // dt), (latency % dt) / dt
    padded = np.concatenate((np.zeros(whole), x))[: len(x)]
    before = np.concatenate((np.zeros(whole + 1), x))[: len(x)]
    y = (1 - part) * padded + part * before
    if part > 0 and whole < len(x):
        y[whole] = 0.0  # the first sample is still on its way
    return y
