# Walls behind the sensor count as hits.


def lidar(pose, segments, angles, r_max, sigma, rng):
    x, y, heading = pose
    segments = np.asarray(segments, dtype=float).reshape(-1, 2, 2)
    distances = []
    for angle in angles:
        dx, dy = math.cos(heading + angle), math.sin(heading + angle)
        hits = []
        for (ax, ay), (bx, by) in segments:
            wx, wy = bx - ax, by - ay
            cross = dx * wy - dy * wx
            if cross == 0:
                continue
            along = abs(((ax - x) * wy - (ay - y) * wx) / cross)
            share = ((ax - x) * dy - (ay - y) * dx) / cross
            if along <= r_max and 0 <= share <= 1:
                hits.append(along)
        noise = sigma * rng.standard_normal()
        distances.append(max(min(hits) + noise, 0.0) if hits else r_max)
    return np.array(distances)
