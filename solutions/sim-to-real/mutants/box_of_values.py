"""The box contains the parameters' own values."""

_sound_plan = plan


def plan():
    made = _sound_plan()
    sheet = {"m": 1.5, "b": 0.6, "Fc": 0.4, "tau": 0.06, "latency": 0.08}
    made["randomization"] = {
        k: [sheet[k] * math.exp(-w), sheet[k] * math.exp(w)] for k, w in LOG_WIDTH.items()
    }
    return made
