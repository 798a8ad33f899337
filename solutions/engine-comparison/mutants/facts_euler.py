"""Wrong: a method called Euler is taken for explicit Euler."""

_FACTS["mujoco"]["default_integrator"] = ("explicit_euler", "https://mujoco.readthedocs.io")
