"""Slow contacts do not rebound, as in engines."""


def impulse_1d(ma, mb, va, vb, restitution):
    closing = max(va - vb, 0.0)
    return (1 + (restitution if closing > 0.01 else 0.0)) * closing / (1 / ma + 1 / mb)
