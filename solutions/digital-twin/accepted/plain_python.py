"""No numpy arrays of its own anywhere: lists, loops and the standard library."""


def encoder(theta, counts_per_rev):
    return [math.floor(angle / (2 * math.pi) * counts_per_rev) for angle in theta]


def imu(true, dt, noise_density, bias_random_walk, bias0, rng):
    bias, measured = [bias0], []
    for _ in range(len(true) - 1):
        bias.append(bias[-1] + rng.normal(0.0, bias_random_walk * dt**0.5))
    for rate, b in zip(true, bias):
        measured.append(float(rate) + b + noise_density * dt**-0.5 * rng.normal())
    return measured, bias


def lidar(pose, segments, angles, r_max, sigma, rng):
    x, y, heading = pose
    ranges = []
    for angle in angles:
        c, s = math.cos(heading + angle), math.sin(heading + angle)
        nearest = None
        for (ax, ay), (bx, by) in segments:
            wx, wy = bx - ax, by - ay
            cross = c * wy - s * wx
            if cross == 0:
                continue
            along = ((ax - x) * wy - (ay - y) * wx) / cross
            share = ((ax - x) * s - (ay - y) * c) / cross
            if along >= 0 and 0 <= share <= 1 and (nearest is None or along < nearest):
                nearest = along
        if nearest is None or nearest > r_max:
            ranges.append(r_max)
        else:
            ranges.append(max(0.0, rng.normal(nearest, sigma)))
    return ranges


def delay_line(x, dt, latency):
    y = []
    for k in range(len(x)):
        place = k - latency / dt
        i = math.floor(place)
        if place < 0:
            y.append(0.0)
        elif i + 1 < len(x):
            y.append(float(x[i]) + (place - i) * float(x[i + 1] - x[i]))
        else:
            y.append(float(x[i]))
    return y


def diff_drive_step(pose, v_left, v_right, track, dt):
    half = (v_right - v_left) / track * dt / 2
    chord = (v_left + v_right) / 2 * dt * (math.sin(half) / half if half else 1.0)
    x, y, heading = map(float, pose)
    return [x + chord * math.cos(heading + half), y + chord * math.sin(heading + half), heading + 2 * half]
