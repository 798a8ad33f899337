"""The latency is rounded to whole samples."""


def delay_line(x, dt, latency):
    whole = round(latency / dt)
    return np.concatenate((np.zeros(whole), x))[: len(x)]
