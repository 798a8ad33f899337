"""Wrong: a step that another program sets is given as the engine's own."""

_FACTS["ode"]["default_step_s"] = (0.001, "https://classic.gazebosim.org")
