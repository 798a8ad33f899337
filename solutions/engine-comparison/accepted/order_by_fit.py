"""Unusual: the order as the least-squares slope over five steps, with keyword arguments and half-steps."""


def _order(engine, omega):
    ends, hs = [], []
    for n in (12, 24, 48, 96, 192):
        h = 0.9 / omega / n
        q, v = engine.run(scene="spring", q0=[0.4], v0=[-omega], h=h, n=n, force=[0.0])
        ends.append(np.array([q[-1][0], v[-1][0] / omega]))
        hs.append(h)
    gaps = [np.linalg.norm(a - b) for a, b in zip(ends, ends[1:], strict=False)]
    return int(np.rint(np.polyfit(np.log(hs[:-1]), np.log(gaps), 1)[0]))
