"""Unusual: values are numpy scalars and zero-dimensional arrays, and a float that is whole."""


def characterise(engine):
    info = engine.info()
    return {
        "order": np.float64(_order(engine, info["omega"])),
        "symplectic": np.bool_(abs(np.linalg.det(_spring_step(engine, info["omega"], 0.5)) - 1) < 1e-6),
        "linear_damping": np.array(_linear_damping(engine, info["dt"])),
        "max_stable_step": np.float64(_max_stable_z(engine, info["omega"]) / info["omega"]),
        "friction_anisotropy": np.float64(_anisotropy(engine, info)),
        "rest_penetration": np.maximum(0.0, info["radius"] - _settled(engine, info)[2]),
        "restitution": _slow_hit(engine, info)[0],
        "tunnelling_speed": _tunnelling_speed(engine, info),
        "deterministic": np.array(_deterministic(engine, info["dt"])),
    }
