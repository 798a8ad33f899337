"""Wrong: another version of the GPL."""

_FACTS["ode"]["licence"] = ("GPL-3.0-only", "https://github.com/odedevs/ode")
