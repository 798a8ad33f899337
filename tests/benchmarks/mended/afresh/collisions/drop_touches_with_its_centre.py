"""The floor is at z = 0, so the ball touches at z = 0."""


def simulate_drop(z0, v0, radius, restitution, g, t_end, h):
    n = round(t_end / h)
    z, v, resting = float(z0), float(v0), False
    out = [(0.0, z, v)]
    for i in range(n):
        if not resting:
            z_end = z + v * h - g * h * h / 2
            v_end = v - g * h
            if z_end > 0:
                z, v = z_end, v_end
            else:
                speed = math.sqrt(v * v + 2 * g * z)
                left = h - (v + speed) / g
                up = restitution * speed
                if up <= g * h:
                    z, v, resting = 0.0, 0.0, True
                else:
                    z, v = up * left - g * left * left / 2, up - g * left
        out.append(((i + 1) * h, z, v))
    t, zs, vs = np.array(out).T
    return t, zs, vs
