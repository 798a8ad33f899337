"""Wrong: only engines with a well-known name are considered."""

_KNOWN = ("anvil", "balsa", "cork", "ode", "bullet", "physx", "mujoco")
_cheapest = choose_engine


def choose_engine(reports, requirements):
    known = {name: report for name, report in reports.items() if name.split(",")[0] in _KNOWN}
    return _cheapest(known, requirements)
