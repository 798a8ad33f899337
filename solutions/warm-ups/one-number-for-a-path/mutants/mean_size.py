"""Takes the mean size."""


def rms(simulated, measured):
    return sum(abs(s - m) for s, m in zip(simulated, measured)) / len(measured)
