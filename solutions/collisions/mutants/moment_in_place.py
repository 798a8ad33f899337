"""The relative motion is computed in the caller's arrays."""

_right_moment = time_of_impact


def time_of_impact(xa, va, ra, xb, vb, rb, dt):
    xb -= xa
    vb -= va
    return _right_moment(np.zeros(len(xb)), np.zeros(len(vb)), ra, xb, vb, rb, dt)
