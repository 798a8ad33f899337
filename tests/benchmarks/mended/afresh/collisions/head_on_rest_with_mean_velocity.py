"""The rest of the step is flown with the mean of the old and the new velocity."""


def simulate_head_on(m, x0, v0, radius, restitution, t_end, h):
    steps = round(t_end / h)
    place, speed = np.array(x0, dtype=float), np.array(v0, dtype=float)
    x, v = [place], [speed]
    for _ in range(steps):
        closing = speed[0] - speed[1]
        gap = place[1] - place[0] - 2 * radius
        wait = gap / closing if closing > 0 else math.inf
        if 0 <= wait < h:
            place = place + speed * wait
            J = (1 + restitution) * closing / (1 / m[0] + 1 / m[1])
            old = speed
            speed = speed + np.array([-J / m[0], J / m[1]])
            place = place + (old + speed) / 2 * (h - wait)
        else:
            place = place + speed * h
        x.append(place)
        v.append(speed)
    return h * np.arange(steps + 1), np.array(x), np.array(v)
