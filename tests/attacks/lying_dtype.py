"""Returns arrays of objects, records, text and dates."""

def scale(values, factor):
    return np.array([object(), None], dtype=object)


def double(x):
    return np.zeros(3, dtype=[("a", "f8")])


def draw(rng, n):
    return np.array(["2020-01-01"] * n, dtype="datetime64[D]")
