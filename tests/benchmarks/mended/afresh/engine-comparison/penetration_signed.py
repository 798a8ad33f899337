"""z - radius: how far it is from the floor."""


def characterise(engine):
    info = engine.info()
    z = _settled(engine, info)[2]
    return {
        "order": _order(engine, info["omega"]),
        "symplectic": bool(abs(np.linalg.det(_spring_step(engine, info["omega"], 0.5)) - 1) < 1e-6),
        "linear_damping": _linear_damping(engine, info["dt"]),
        "max_stable_step": _max_stable_z(engine, info["omega"]) / info["omega"],
        "friction_anisotropy": _anisotropy(engine, info),
        "rest_penetration": z - info["radius"],
        "restitution": _slow_hit(engine, info)[0],
        "tunnelling_speed": _tunnelling_speed(engine, info),
        "deterministic": _deterministic(engine, info["dt"]),
    }
