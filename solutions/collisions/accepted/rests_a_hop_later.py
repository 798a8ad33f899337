"""The drop: the speed before a contact decides whether the ball rests; contacts are found by bisection."""


def simulate_drop(z0, v0, radius, restitution, g, t_end, h):
    rows, z, v, rests = [(0.0, z0, v0)], z0, v0, False
    for i in range(1, round(t_end / h) + 1):
        left = h
        while left > 0 and not rests:
            if z <= radius and abs(v) <= g * h:
                rests = True
                break

            def height(s, z=z, v=v):
                return z - radius + v * s - g * s * s / 2

            if height(left) >= 0:
                z, v, left = radius + height(left), v - g * left, 0.0
                break
            low, high = max(v / g, 0.0), left
            for _ in range(80):
                middle = (low + high) / 2
                low, high = (middle, high) if height(middle) > 0 else (low, middle)
            speed, left = g * high - v, left - high
            rests, z, v = speed <= g * h, radius, restitution * speed
        if rests:
            z, v = radius, 0.0
        rows.append((i * h, z, v))
    return [list(column) for column in zip(*rows)]
