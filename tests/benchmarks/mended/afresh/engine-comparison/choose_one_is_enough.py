"""An engine that meets one of the requirements is a candidate."""


def choose_engine(reports, requirements):
    best = None
    for name, report in reports.items():
        fits = not requirements
        for req in requirements:
            have, want = report.get(req["key"]), req["value"]
            if have is None:
                continue
            if req["op"] == "==":
                fits = fits or have == want
            elif req["op"] == "<=":
                fits = fits or have <= want
            else:
                fits = fits or have >= want
        if fits and (best is None or report["cost"] < reports[best]["cost"]):
            best = name
    return best
