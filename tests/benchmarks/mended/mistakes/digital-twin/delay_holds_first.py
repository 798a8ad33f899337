# Before the first sample has arrived it is held.


def delay_line(x, dt, latency):
    t = dt * np.arange(len(x))
    return np.interp(t - latency, t, x)
