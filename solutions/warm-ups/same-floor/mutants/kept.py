"""Keeps both numbers."""


def same_floor(erp, cfm, h, new_h):
    return erp, cfm
