"""Wrong: a name counts more than a number."""

_cheapest = choose_engine


def choose_engine(reports, requirements):
    for name in sorted(reports):
        if name.startswith(("mujoco", "ode")) and _cheapest({name: reports[name]}, requirements):
            return name
    return _cheapest(reports, requirements)
