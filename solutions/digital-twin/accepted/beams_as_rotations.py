"""Each beam turns the walls into its own frame with complex numbers and looks where they cross its axis."""


def lidar(pose, segments, angles, r_max, sigma, rng):
    ends = np.asarray(segments) @ np.array([1, 1j]) - (pose[0] + 1j * pose[1])
    turned = ends[None] * np.exp(-1j * (pose[2] + np.asarray(angles)))[:, None, None]
    a, b = turned[..., 0], turned[..., 1]
    crosses = a.imag * b.imag < 0
    part = np.where(crosses, a.imag / np.where(crosses, a.imag - b.imag, 1.0), np.nan)
    place = a.real + part * (b.real - a.real)
    nearest = np.fmin.reduce(np.where(place > 0, place, np.inf), axis=1)
    nearest = np.where(nearest <= r_max, nearest, np.inf)
    noise = rng.normal(0.0, sigma, len(nearest))
    return [float(max(d + e, 0.0)) if d < np.inf else r_max for d, e in zip(nearest, noise)]
