"""Half the fleet's width is typical."""


def plan():
    common = {
        "estimator": "integral_least_squares",
        "mitigation": "system_identification",
        "metric": "relative_half_width",
        "unit": "%",
    }
    w = {"m": 0.35, "b": 0.50, "Fc": 0.30, "tau": 0.40, "latency": 0.40}
    return {
        "gaps": [
            {"source": "friction", "parameter": "b", "excitation": "prbs", "threshold": 10, **common},
            {"source": "environment", "parameter": "m", "excitation": "prbs", "threshold": 3, **common},
            {
                "source": "delay",
                "parameter": "lag",
                "excitation": "prbs",
                "threshold": 10,
                **common,
                "estimator": "delay_grid",
            },
            {
                "source": "sensor_noise",
                "parameter": "noise",
                "excitation": "rest",
                "threshold": 10,
                **common,
                "estimator": "standard_deviation",
                "mitigation": "noise_model",
                "metric": "relative_error",
            },
        ],
        "excitation_budget_s": 20.0,
        "randomization": {k: [math.exp(-x / 2), math.exp(x / 2)] for k, x in w.items()},
        "metric": "success",
        "threshold": 0.92,
    }
