"""Arrays of ends, numpy's own booleans, and keys in another order."""

_judge = validate


def validate(sim, real, spec):
    report = _judge(sim, real, spec)
    if report["intervals"] is not None:
        report["intervals"] = {key: np.array(ends) for key, ends in report["intervals"].items()}
        report["accepted"] = np.bool_(report["accepted"])
    return dict(reversed(report.items()))
