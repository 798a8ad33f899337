"""The masses count with powers that someone remembers."""


def impulse_1d(ma, mb, va, vb, restitution):
    s = va - vb
    return (1 + restitution) * s * ma**0.7 * mb**0.3 / 2 if s > 0 else 0.0
