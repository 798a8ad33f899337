"""Three gaps are three gaps."""


def plan():
    gaps = []
    for parameter in ("b", "Fc"):
        gaps.append(
            dict(
                source="friction",
                parameter=parameter,
                excitation="prbs",
                estimator="integral_least_squares",
                mitigation="system_identification",
                metric="relative_half_width",
                threshold=0.1,
                unit="1",
            )
        )
    gaps.append(
        dict(
            source="delay",
            parameter="latency",
            excitation="prbs",
            estimator="delay_grid",
            mitigation="system_identification",
            metric="relative_half_width",
            threshold=0.1,
            unit="1",
        )
    )
    box = {}
    for name, w in zip(NAMES, (0.35, 0.5, 0.3, 0.4, 0.4)):
        box[name] = [math.exp(-w), math.exp(w)]
    return dict(gaps=gaps, excitation_budget_s=20, randomization=box, metric="success", threshold=0.92)
