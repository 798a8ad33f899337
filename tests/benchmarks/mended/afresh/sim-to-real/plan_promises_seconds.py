"""The threshold is the settling time, in seconds."""


def plan():
    def gap(source, parameter, mitigation, threshold, excitation="prbs", estimator="integral_least_squares"):
        return {
            "source": source,
            "parameter": parameter,
            "excitation": excitation,
            "estimator": estimator,
            "mitigation": mitigation,
            "metric": "relative_half_width",
            "threshold": threshold,
            "unit": "%",
        }

    return {
        "gaps": [
            gap("environment", "m", "domain_randomization", 3.0),
            gap("friction", "b", "system_identification", 10.0),
            gap("friction", "Fc", "system_identification", 10.0),
            gap("actuator_lag", "lag", "system_identification", 10.0, estimator="delay_grid"),
            gap("sensor_noise", "noise", "noise_model", 5.0, "rest", "standard_deviation"),
        ],
        "excitation_budget_s": 20.0,
        "randomization": {k: [math.exp(-w), math.exp(w)] for k, w in LOG_WIDTH.items()},
        "metric": "success",
        "threshold": 1.7,
    }
