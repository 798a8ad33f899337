"""A wall is a line through two points."""


def lidar(pose, segments, angles, r_max, sigma, rng):
    segments = np.asarray(segments, dtype=float)
    direction = np.asarray(angles) + pose[2]
    d = np.stack([np.cos(direction), np.sin(direction)], axis=1)
    result = np.full(len(d), float(r_max))
    for i in range(len(d)):
        hits = []
        for p, e in segments:
            edge = e - p
            normal = np.array([-edge[1], edge[0]])
            speed = d[i] @ normal
            if speed == 0:
                continue
            r = (p - np.asarray(pose[:2])) @ normal / speed
            if r > 0:
                hits.append(r)
        if hits and min(hits) <= r_max:
            result[i] = max(min(hits) + rng.normal(0, sigma), 0)
    return result
