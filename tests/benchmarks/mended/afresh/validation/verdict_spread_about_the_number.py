"""The spread about the number from all runs."""


def interval_of_each(pairs):
    """The jackknife over runs: how much each number moves as one run or another is left out."""
    n = len(pairs)
    numbers = measures(pairs)
    without = [measures(pairs[:i] + pairs[i + 1 :]) for i in range(n)]
    intervals = {}
    for key, value in numbers.items():
        values = np.array([left[key] for left in without])
        error = math.sqrt((n - 1) / n * np.sum((values - value) ** 2))
        half = T95[n - 2] * error  # n - 1 degrees of freedom
        intervals[key] = (value - half, value + half)
    return intervals
