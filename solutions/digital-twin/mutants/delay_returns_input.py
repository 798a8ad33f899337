"""Without latency the caller's own array is returned."""

_whole = delay_line


def delay_line(x, dt, latency):
    return x if latency == 0 else _whole(x, dt, latency)
