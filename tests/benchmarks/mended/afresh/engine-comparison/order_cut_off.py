"""int() makes a whole number of it."""


def _order(engine, omega):
    ends = []
    for n in (16, 32, 64):
        q, v = engine.run("spring", [1.0], [0.5 * omega], 1.1 / omega / n, n, [0.0])
        ends.append(np.array([q[-1][0], v[-1][0] / omega]))
    a = np.linalg.norm(ends[0] - ends[1])
    b = np.linalg.norm(ends[1] - ends[2])
    return int(math.log(a / b, 2))
