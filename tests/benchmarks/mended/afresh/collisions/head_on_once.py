"""A module-level flag says that the balls have collided and is never cleared, so a second call has no impact."""

collided = False


def simulate_head_on(m, x0, v0, radius, restitution, t_end, h):
    global collided
    n = round(t_end / h)
    place, speed = np.array(x0, float), np.array(v0, float)
    t, x, v = [0.0], [place], [speed]
    for i in range(n):
        closing = speed[0] - speed[1]
        tau = (place[1] - place[0] - 2 * radius) / closing if closing > 0 else math.inf
        if not collided and tau <= h:
            collided = True
            place = place + speed * tau
            J = impulse_1d(m[0], m[1], speed[0], speed[1], restitution)
            speed = speed + J * np.array([-1 / m[0], 1 / m[1]])
            place = place + speed * (h - tau)
        else:
            place = place + speed * h
        t.append(h * (i + 1))
        x.append(place)
        v.append(speed)
    return np.array(t), np.array(x), np.array(v)
