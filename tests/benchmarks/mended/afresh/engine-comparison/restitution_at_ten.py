"""The body meets the wall at 10 m/s."""


def characterise(engine):
    info = engine.info()
    face = info["radius"] + info["wall_thickness"] / 2
    speed = min(10.0, info["radius"] / info["dt"])
    _, v = engine.run("wall", [-face - 2.5 * speed * info["dt"]], [speed], info["dt"], 10, [0])
    hit = next(i for i in range(11) if v[i][0] <= 0)
    return {
        "order": _order(engine, info["omega"]),
        "symplectic": abs(np.linalg.det(_spring_step(engine, info["omega"], 0.5)) - 1) < 1e-6,
        "linear_damping": _linear_damping(engine, info["dt"]),
        "max_stable_step": _max_stable_z(engine, info["omega"]) / info["omega"],
        "friction_anisotropy": _anisotropy(engine, info),
        "rest_penetration": max(0.0, info["radius"] - _settled(engine, info)[2]),
        "restitution": -v[hit][0] / v[hit - 1][0],
        "tunnelling_speed": _tunnelling_speed(engine, info),
        "deterministic": _deterministic(engine, info["dt"]),
    }
