"""By way of length and angle."""


def friction(wanted, normal, mu):
    size = min(math.hypot(*wanted), mu * normal)
    angle = math.atan2(wanted[1], wanted[0])
    return size * math.cos(angle), size * math.sin(angle)
