"""Every drive has backlash."""


def plan():
    w = {"m": 0.35, "b": 0.50, "Fc": 0.30, "tau": 0.40, "latency": 0.40}
    rows = [
        (
            "friction",
            "b",
            "prbs",
            "integral_least_squares",
            "system_identification",
            "relative_half_width",
            10,
        ),
        ("gear_backlash", "play", "constant", "standard_deviation", "noise_model", "relative_error", 10),
        ("delay", "lag", "prbs", "delay_grid", "system_identification", "relative_half_width", 10),
        (
            "environment",
            "m",
            "prbs",
            "integral_least_squares",
            "domain_randomization",
            "relative_half_width",
            3,
        ),
    ]
    keys = ("source", "parameter", "excitation", "estimator", "mitigation", "metric", "threshold")
    return {
        "gaps": [{**dict(zip(keys, row)), "unit": "%"} for row in rows],
        "excitation_budget_s": 20,
        "randomization": {k: [math.exp(-x), math.exp(x)] for k, x in w.items()},
        "metric": "success",
        "threshold": 0.91,
    }
