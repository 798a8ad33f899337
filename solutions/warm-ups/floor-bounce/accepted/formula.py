"""One formula for both cases."""


def after_floor(v, e):
    incoming = (abs(v) - v) / 2
    return v + (1 + e) * incoming
