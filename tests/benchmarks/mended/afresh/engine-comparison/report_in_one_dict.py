"""The same dict is filled and returned in every call."""

_report = {}


def characterise(engine):
    info = engine.info()
    _report.update(
        {
            "order": _order(engine, info["omega"]),
            "symplectic": abs(np.linalg.det(_spring_step(engine, info["omega"], 0.5)) - 1) < 1e-6,
            "linear_damping": _linear_damping(engine, info["dt"]),
            "max_stable_step": _max_stable_z(engine, info["omega"]) / info["omega"],
            "friction_anisotropy": _anisotropy(engine, info),
            "rest_penetration": max(0.0, info["radius"] - _settled(engine, info)[2]),
            "restitution": _slow_hit(engine, info)[0],
            "tunnelling_speed": _tunnelling_speed(engine, info),
            "deterministic": _deterministic(engine, info["dt"]),
        }
    )
    return _report
