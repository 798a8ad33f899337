"""Divides by one less."""


def rms(simulated, measured):
    return math.sqrt(sum((s - m) ** 2 for s, m in zip(simulated, measured)) / (len(measured) - 1))
