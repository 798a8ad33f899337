# ODE's integrator is taken for explicit Euler.

_FACTS = {
    "ode": {
        "licence": ("LGPL-2.1-or-later OR BSD-3-Clause", "https://github.com/odedevs/ode"),
        "language": ("C++", "https://github.com/odedevs/ode"),
        "default_integrator": ("explicit_euler", "https://ode.org/wiki/index.php/Manual"),
        "default_step_s": (None, "https://ode.org/wiki/index.php/Manual"),
        "used_by": (["Gazebo Classic", "Webots"], "https://classic.gazebosim.org"),
    },
    "bullet": {
        "licence": ("Zlib", "https://github.com/bulletphysics/bullet3"),
        "language": ("C++", "https://github.com/bulletphysics/bullet3"),
        "default_integrator": ("semi_implicit_euler", "https://github.com/bulletphysics/bullet3"),
        "default_step_s": (1 / 60, "https://github.com/bulletphysics/bullet3"),
        "used_by": (["PyBullet", "Blender"], "https://pybullet.org"),
    },
    "physx": {
        "licence": ("BSD-3-Clause", "https://github.com/NVIDIA-Omniverse/PhysX"),
        "language": ("C++", "https://github.com/NVIDIA-Omniverse/PhysX"),
        "default_integrator": ("semi_implicit_euler", "https://nvidia-omniverse.github.io/PhysX/"),
        "default_step_s": (None, "https://nvidia-omniverse.github.io/PhysX/"),
        "used_by": (["Isaac Sim", "Unity"], "https://github.com/NVIDIA-Omniverse/PhysX"),
    },
    "mujoco": {
        "licence": ("Apache-2.0", "https://github.com/google-deepmind/mujoco"),
        "language": ("C++", "https://github.com/google-deepmind/mujoco"),
        "default_integrator": (
            "semi_implicit_euler",
            "https://mujoco.readthedocs.io/en/stable/XMLreference.html",
        ),
        "default_step_s": (0.002, "https://mujoco.readthedocs.io/en/stable/XMLreference.html"),
        "used_by": (["Gymnasium", "dm_control"], "https://gymnasium.farama.org"),
    },
}
