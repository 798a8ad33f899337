"""Returns nothing, empty things, and arrays without dimensions."""

def scale(values, factor):
    return np.zeros((0, 3))


def sample(f, points):
    return [[], [[]], {}]


def compose(f, g, x):
    return np.array(np.nan)


def double(x):
    return np.zeros((3, 0, 2), dtype=complex)


def draw(rng, n):
    return ""


def advance(accel, t, q, v, h):
    return "qv"
