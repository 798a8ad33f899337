"""The standard error is how far the numbers scatter with one run left out."""


def interval_of_each(pairs):
    n = len(pairs)
    numbers = measures(pairs)
    without = [measures(pairs[:i] + pairs[i + 1 :]) for i in range(n)]
    half = {key: T95[n - 2] * float(np.std([left[key] for left in without])) for key in numbers}
    return {key: (value - half[key], value + half[key]) for key, value in numbers.items()}
