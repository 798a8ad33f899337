"""Contact is tested only if the ball is already falling at the start of the step, so an apex and a landing in one step fall through."""


def simulate_drop(z0, v0, radius, restitution, g, t_end, h):
    N = round(t_end / h)
    t = np.arange(N + 1) * h
    z, v = float(z0), float(v0)
    zs, vs = [z], [v]
    resting = False
    for _ in range(N):
        if not resting:
            z_new = z + v * h - g * h**2 / 2
            if z_new > radius or v > 0:
                z, v = z_new, v - g * h
            else:
                speed = math.sqrt(v**2 + 2 * g * (z - radius))
                left = h - (v + speed) / g
                up = restitution * speed
                if up <= g * h:
                    resting = True
                    z, v = radius, 0.0
                else:
                    z = radius + up * left - g * left**2 / 2
                    v = up - g * left
        zs.append(z)
        vs.append(v)
    return t, np.array(zs), np.array(vs)
