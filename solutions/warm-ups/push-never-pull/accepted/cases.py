"""Two cases."""


def applied(total, wanted):
    if total + wanted < 0:
        return -total
    return wanted
