"""Takes the angles as degrees."""


def hand(a1, a2, l1, l2):
    a, b = math.radians(a1), math.radians(a1 + a2)
    return l1 * math.cos(a) + l2 * math.cos(b), l1 * math.sin(a) + l2 * math.sin(b)
