"""Forgets the root."""


def rms(simulated, measured):
    return sum((s - m) ** 2 for s, m in zip(simulated, measured)) / len(measured)
