"""As it stands in the file."""


def error_at_end(positions, omega):
    t = len(positions) * H
    return abs(positions[-1] - math.cos(omega * t))
