"""After the impact comes a step."""


def simulate_head_on(m, x0, v0, radius, restitution, t_end, h):
    N = round(t_end / h)
    place = np.array(x0, dtype=float)
    speed = np.array(v0, dtype=float)
    t, x, v = [0.0], [place], [speed]
    for i in range(N):
        gap = place[1] - place[0] - 2 * radius
        closing = speed[0] - speed[1]
        if closing > 0 and gap <= closing * h:
            tau = max(gap, 0.0) / closing
            place = place + speed * tau
            J = impulse_1d(m[0], m[1], speed[0], speed[1], restitution)
            speed = np.array([speed[0] - J / m[0], speed[1] + J / m[1]])
            place = place + speed * h
        else:
            place = place + speed * h
        t.append((i + 1) * h)
        x.append(place)
        v.append(speed)
    return np.array(t), np.array(x), np.array(v)
