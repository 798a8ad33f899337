"""Takes the mean difference."""


def rms(simulated, measured):
    return abs(sum(s - m for s, m in zip(simulated, measured)) / len(measured))
