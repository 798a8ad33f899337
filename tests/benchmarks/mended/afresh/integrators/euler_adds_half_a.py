"""s = v t + a t²/2 is how far it goes in a step, so explicit Euler must have it too."""


def explicit_euler_step(accel, t, q, v, h):
    a = np.asarray(accel(t, q, v))
    new_q = q + v * h + 0.5 * a * h**2
    new_v = v + a * h
    return new_q, new_v
