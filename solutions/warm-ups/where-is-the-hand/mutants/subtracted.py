"""Turns the elbow the other way."""


def hand(a1, a2, l1, l2):
    return l1 * math.cos(a1) + l2 * math.cos(a1 - a2), l1 * math.sin(a1) + l2 * math.sin(a1 - a2)
