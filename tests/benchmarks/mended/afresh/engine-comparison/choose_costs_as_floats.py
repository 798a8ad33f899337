"""Costs are compared as floats, whatever their size."""


def choose_engine(reports, requirements):
    names, costs = [], []
    for name, report in reports.items():
        if all(
            report.get(r["key"]) is not None and _OPERATORS[r["op"]](report[r["key"]], r["value"])
            for r in requirements
        ):
            names.append(name)
            costs.append(report["cost"])
    return names[int(np.argmin(np.array(costs, dtype=float)))] if names else None
