"""github.com/... is an address."""


def engine_facts():
    site = {
        "ode": "bitbucket.org/odedevs/ode",
        "bullet": "github.com/bulletphysics/bullet3",
        "physx": "github.com/NVIDIA-Omniverse/PhysX",
        "mujoco": "github.com/google-deepmind/mujoco",
    }
    facts = {
        "ode": ("BSD-3-Clause", "C++", "semi_implicit_euler", None, ["Gazebo Classic"]),
        "bullet": ("Zlib", "C++", "semi_implicit_euler", 1 / 240, ["PyBullet"]),
        "physx": ("BSD-3-Clause", "C++", "semi_implicit_euler", None, ["Isaac Sim"]),
        "mujoco": ("Apache-2.0", "C", "semi_implicit_euler", 0.002, ["dm_control"]),
    }
    fields = ("licence", "language", "default_integrator", "default_step_s", "used_by")
    return [
        {"engine": engine, "field": field, "value": value, "source": site[engine], "as_of": "2026-11-01"}
        for engine, values in facts.items()
        for field, value in zip(fields, values)
    ]
