"""The standard error is the spread of the runs over the root of their number."""


def interval_of_each(pairs):
    n = len(pairs)
    numbers, single = measures(pairs), [measures([pair]) for pair in pairs]
    half = {
        key: T95[n - 2] * float(np.std([one[key] for one in single], ddof=1)) / math.sqrt(n)
        for key in numbers
    }
    return {key: (value - half[key], value + half[key]) for key, value in numbers.items()}
