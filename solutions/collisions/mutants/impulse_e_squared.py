"""The bodies separate at e squared times the speed of approach."""


def impulse_1d(ma, mb, va, vb, restitution):
    return (1 + restitution**2) * (va - vb) / (1 / ma + 1 / mb) if va > vb else 0.0
