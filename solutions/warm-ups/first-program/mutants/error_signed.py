"""Loses the size."""


def error_at_end(positions, omega):
    return math.cos(omega * (len(positions) - 1) * H) - positions[-1]
