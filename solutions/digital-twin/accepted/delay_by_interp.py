"""The delay by np.interp at k*dt - latency: where that is zero but for rounding, it may give 0.0."""


def delay_line(x, dt, latency):
    t = dt * np.arange(len(x))
    return np.interp(t - latency, t, x, left=0.0)
