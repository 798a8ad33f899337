"""T95[n - 1] for n runs."""


def interval_of_each(pairs):
    number, n = measures(pairs), len(pairs)
    left_out = [measures(pairs[:i] + pairs[i + 1 :]) for i in range(n)]
    intervals = {}
    for key, value in number.items():
        x = np.array([one[key] for one in left_out])
        error = math.sqrt((n - 1) / n * np.sum((x - x.mean()) ** 2))
        intervals[key] = (value - T95[n - 1] * error, value + T95[n - 1] * error)
    return intervals
