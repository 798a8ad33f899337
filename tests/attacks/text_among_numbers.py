"""Returns one long text among many numbers, which an array would repeat for each."""

def scale(values, factor):
    return ["x" * 500_000, *[1.0] * 50_000]


def double(x):
    return [["y" * 400_000] + [0.0] * 20_000, [1.0] * 20_001]


draw = lambda rng, n: scale(0, 0)
