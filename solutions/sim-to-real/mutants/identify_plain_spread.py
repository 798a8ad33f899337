"""The plain spread of the jackknife's refits."""

_scaled = identify


def identify(t, u, y):
    n = len(y) // 100
    shrink = math.sqrt(n) / (n - 1)  # from sqrt((n-1)/n * sum) to sqrt(sum/(n-1))
    return {
        k: [x, x + shrink * (low - x), x + shrink * (high - x)]
        for k, (x, low, high) in _scaled(t, u, y).items()
    }
