"""Friction is what keeps it at rest, so watch it rest."""


def plan():
    def gap(source, parameter, excitation, estimator, mitigation, metric, threshold, unit="%"):
        return {
            "source": source,
            "parameter": parameter,
            "excitation": excitation,
            "estimator": estimator,
            "mitigation": mitigation,
            "metric": metric,
            "threshold": threshold,
            "unit": unit,
        }

    widths = {"m": 0.35, "b": 0.50, "Fc": 0.30, "tau": 0.40, "latency": 0.40}
    return {
        "gaps": [
            gap(
                "friction",
                "Fc",
                "rest",
                "integral_least_squares",
                "system_identification",
                "relative_half_width",
                10,
            ),
            gap("delay", "lag", "prbs", "delay_grid", "system_identification", "relative_half_width", 10),
            gap(
                "environment",
                "m",
                "prbs",
                "integral_least_squares",
                "domain_randomization",
                "relative_half_width",
                3,
            ),
            gap("sensor_noise", "noise", "rest", "standard_deviation", "noise_model", "relative_error", 10),
        ],
        "excitation_budget_s": 20,
        "randomization": {k: [math.exp(-w), math.exp(w)] for k, w in widths.items()},
        "metric": "success",
        "threshold": 0.92,
    }
