"""By the ratio of the two steps."""


def same_floor(erp, cfm, h, new_h):
    r = new_h / h
    share = r * erp + 1 - erp
    return [r * erp / share, cfm / share]
