"""Returns what is endless, cyclic, enormous or no number."""

def scale(values, factor):
    cyclic = []
    cyclic.append(cyclic)
    return cyclic


def advance(accel, t, q, v, h):
    return np.array([np.nan]), np.array([np.inf])


def sample(f, points):
    return [10**400, float("nan"), -float("inf")]


def compose(f, g, x):
    return 1 << 62


def double(x):
    deep = 0.0
    for _ in range(30):
        deep = [deep]
    return deep


def draw(rng, n):
    return np.zeros(9 << 20)
