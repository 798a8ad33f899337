"""Wrong: the rate of a swing's amplitude, half that of a free body."""


def _linear_damping(engine, dt):
    omega = engine.info()["omega"]
    # ln det of the step's matrix is the loss of area; its half is the loss of amplitude.
    z = omega * dt / 1000
    return -math.log(np.linalg.det(_spring_step(engine, omega, z))) / 2 / (dt / 1000)
