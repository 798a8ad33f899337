"""Only the two smallest steps are used for the slope; the other points are ignored."""

import math


def observed_order(hs, errors):
    points = sorted(zip([float(h) for h in hs], [float(e) for e in errors]))
    (h1, e1), (h2, e2) = points[0], points[1]
    return (math.log(e2) - math.log(e1)) / (math.log(h2) - math.log(h1))
