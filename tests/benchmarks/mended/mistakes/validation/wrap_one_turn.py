# At most one turn is taken off.


def wrap_angle(e):
    e = np.array(e, dtype=float)
    e[e >= np.pi] -= 2 * np.pi
    e[e < -np.pi] += 2 * np.pi
    return e
