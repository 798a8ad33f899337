"""Unusual: right values of another kind: ODE's other licence, PyBullet's step, C for MuJoCo, tuples."""


def engine_facts():
    rows = (
        (
            "ode",
            "BSD-3-Clause",
            "C++",
            None,
            ("Webots",),
            "https://github.com/odedevs/ode/blob/master/LICENSE-BSD.TXT",
        ),
        ("bullet", "zlib", "c++", 1 / 240, ("Blender", "My own game"), "http://pybullet.org/"),
        (
            "physx",
            "BSD-3-Clause",
            "C++",
            None,
            ("NVIDIA Isaac Sim",),
            "https://github.com/NVIDIA-Omniverse/PhysX",
        ),
        (
            "mujoco",
            "Apache-2.0",
            "C",
            0.002,
            ("MuJoCo Playground",),
            "https://mujoco.readthedocs.io/en/stable/",
        ),
    )
    found = []
    for engine, licence, language, step, used_by, source in rows:
        values = {
            "used_by": used_by,
            "licence": licence,
            "default_step_s": step,
            "language": language,
            "default_integrator": "semi_implicit_euler",
        }
        for field, value in values.items():
            found.append(
                {"engine": engine, "field": field, "value": value, "source": source, "as_of": "2025-06-30"}
            )
    return tuple(reversed(found))
