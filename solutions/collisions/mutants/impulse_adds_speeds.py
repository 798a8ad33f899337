"""The two speeds are added, also where one body chases the other."""


def impulse_1d(ma, mb, va, vb, restitution):
    return (1 + restitution) * (abs(va) + abs(vb)) / (1 / ma + 1 / mb) if va > vb else 0.0
