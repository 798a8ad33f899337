"""Other gaps and words: fractions instead of per cent, a shorter bench run, rounded factors, a wider box."""


def plan():
    keys = ("source", "parameter", "excitation", "estimator", "mitigation")
    rows = [
        ("delay", "latency", "prbs", "delay_grid", "system_identification"),
        ("actuator_lag", "tau", "prbs", "delay_grid", "domain_randomization"),
        ("environment", "b", "chirp", "integral_least_squares", "transfer_learning"),
        ("friction", "Fc", "multisine", "integral_least_squares", "domain_randomization"),
    ]
    last = {"metric": "relative_error", "threshold": 0.1, "unit": "1"}
    return {
        "gaps": tuple({**dict(zip(keys, row)), **last} for row in rows),
        "excitation_budget_s": 18,
        "randomization": {
            "m": (0.68, 1.45),
            "b": (0.59, 1.68),
            "Fc": (0.72, 1.38),
            "tau": (0.66, 1.52),
            "latency": (0.66, 1.52),
        },
        "metric": "success",
        "threshold": 0.92,
    }
