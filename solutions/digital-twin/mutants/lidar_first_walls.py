"""The walls of the first scan are kept: walls do not move."""

_scan = lidar
_WALLS = []


def lidar(pose, segments, angles, r_max, sigma, rng):
    if not _WALLS:
        _WALLS.append(np.array(segments))
    return _scan(pose, _WALLS[0], angles, r_max, sigma, rng)
