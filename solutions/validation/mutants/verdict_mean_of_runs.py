"""Each run counts the same, however long it is."""

_judged = validate


def validate(sim, real, spec):
    report = _judged(sim, real, spec)
    if report["runs_used"]:
        e = [columns(pair) for pair in held_out_pairs(sim, real)]
        report["rmse"] = float(np.mean([np.sqrt(np.mean((y - r) ** 2)) for y, _, r in e]))
    return report
