"""What conserves area has no damping, and the other way round."""


def characterise(engine):
    info = engine.info()
    damping = _linear_damping(engine, info["dt"])
    return {
        "order": _order(engine, info["omega"]),
        "symplectic": bool(damping < 1e-6),
        "linear_damping": damping,
        "max_stable_step": _max_stable_z(engine, info["omega"]) / info["omega"],
        "friction_anisotropy": _anisotropy(engine, info),
        "rest_penetration": max(0.0, info["radius"] - _settled(engine, info)[2]),
        "restitution": _slow_hit(engine, info)[0],
        "tunnelling_speed": _tunnelling_speed(engine, info),
        "deterministic": _deterministic(engine, info["dt"]),
    }
