"""Wrong: the new Gazebo listed as a user of ODE."""

_FACTS["ode"]["used_by"] = (["Gazebo Sim"], "https://gazebosim.org")
