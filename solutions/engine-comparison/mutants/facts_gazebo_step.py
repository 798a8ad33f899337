"""Wrong: a program's habit for the engine's own step."""

_FACTS["ode"]["default_step_s"] = (0.001, "https://classic.gazebosim.org")
