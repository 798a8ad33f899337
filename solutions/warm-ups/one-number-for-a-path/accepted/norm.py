"""By the length of the vector of differences."""


def rms(simulated, measured):
    return math.dist(simulated, measured) / math.sqrt(len(measured))
