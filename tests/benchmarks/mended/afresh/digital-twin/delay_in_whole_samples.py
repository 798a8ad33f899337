"""A delay is a number of samples."""


def delay_line(x, dt, latency):
    x = np.asarray(x, dtype=float)
    n = round(latency / dt)
    y = np.zeros(len(x))
    if n == 0:
        return x.copy()
    if n < len(x):
        y[n:] = x[:-n]
    return y
