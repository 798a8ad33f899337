"""Answers named problems from their parameters instead of stepping."""

def velocity_verlet_step(accel, t, q, v, h):
    omega = getattr(accel, "omega", 1.0)
    return q * np.cos(omega * h) + v * np.sin(omega * h) / omega, v * np.cos(omega * h) - q * omega * np.sin(omega * h)


rk4_step = velocity_verlet_step
