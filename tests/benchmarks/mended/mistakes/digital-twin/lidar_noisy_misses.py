# Beams that hit nothing are noisy too.


def lidar(pose, segments, angles, r_max, sigma, rng):
    x, y, heading = pose
    segments = np.asarray(segments, dtype=float).reshape(-1, 2, 2)
    distances = []
    for angle in angles:
        dx, dy = math.cos(heading + angle), math.sin(heading + angle)
        nearest = r_max
        for (ax, ay), (bx, by) in segments:
            wx, wy = bx - ax, by - ay
            cross = dx * wy - dy * wx
            if cross == 0:
                continue
            along = ((ax - x) * wy - (ay - y) * wx) / cross
            share = ((ax - x) * dy - (ay - y) * dx) / cross
            if along >= 0 and 0 <= share <= 1:
                nearest = min(nearest, along)
        distances.append(max(nearest + sigma * rng.standard_normal(), 0.0))
    return np.array(distances)
