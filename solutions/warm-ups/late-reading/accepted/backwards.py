"""Goes from the newest to the oldest."""


def seen(times, values, latency, now):
    for k in range(len(times) - 1, -1, -1):
        if times[k] <= now - latency:
            return values[k]
    return None
