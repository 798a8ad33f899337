"""The lag by the Gauss-Newton method: a small shift gives an error of the slope times that shift."""


def best_shift(pairs):
    late = 0.0
    for _ in range(25):
        top = bottom = 0.0
        for simulated, r in pairs:
            t = np.asarray(r["t"])
            y = np.asarray(simulated["y"])
            inside = (t + late >= t[0]) & (t + late <= t[-1])
            shifted = np.interp(t[inside] + late, t, y)
            slope = np.interp(t[inside] + late, t, np.gradient(y, t))
            top += np.sum(slope * (np.asarray(r["y"])[inside] - shifted))
            bottom += np.sum(slope**2)
        late = float(np.clip(late + top / bottom, -0.25, 0.25))
    return late
