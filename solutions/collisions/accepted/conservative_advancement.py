"""Time of impact by moving ahead as far as is safe, again and again; the last digits by bisection."""


def time_of_impact(xa, va, ra, xb, vb, rb, dt):
    x, v = np.asarray(xb) - xa, np.asarray(vb) - va
    reach, speed = ra + rb, float(np.linalg.norm(v))

    def gap(t):
        return float(np.linalg.norm(x + t * v)) - reach

    if x @ v >= 0:
        return None
    if gap(0.0) <= 0:
        return 0.0
    nearest = min(-float(x @ v) / speed**2, dt)  # past this point the gap grows again
    if gap(nearest) > 0:
        return None
    t, late = 0.0, nearest
    while gap(t) > 1e-3 * reach:
        t += gap(t) / speed
    for _ in range(200):
        middle = (t + late) / 2
        t, late = (middle, late) if gap(middle) > 0 else (t, middle)
    return late
