"""The head-on program built from the student's other functions, in vectors of one dimension."""


def simulate_head_on(m, x0, v0, radius, restitution, t_end, h):
    x, v = [np.array([c], float) for c in x0], [np.array([c], float) for c in v0]
    rows = [(0.0, [x[0][0], x[1][0]], [v[0][0], v[1][0]])]
    for i in range(round(t_end / h)):
        left = h
        wait = time_of_impact(x[0], v[0], radius, x[1], v[1], radius, left)
        if wait is not None:
            x = [p + wait * u for p, u in zip(x, v)]
            v = list(resolve(m[0], m[1], v[0], v[1], np.array([1.0]), restitution))
            left -= wait
        x = [p + left * u for p, u in zip(x, v)]
        rows.append(((i + 1) * h, [x[0][0], x[1][0]], [v[0][0], v[1][0]]))
    return tuple(map(list, zip(*rows)))
