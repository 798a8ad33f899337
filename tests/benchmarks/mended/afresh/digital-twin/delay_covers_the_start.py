"""A signal that is late is zero until then, and itself from then on."""


def delay_line(x, dt, latency):
    t = dt * np.arange(len(x))
    return np.where(t >= latency, x, 0.0)
