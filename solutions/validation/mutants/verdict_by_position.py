"""The first run of one list is the first run of the other."""


def held_out_pairs(sim, real):
    pairs = zip(sim["runs"], real["runs"])
    return [(s, r) for s, r in pairs if s["id"] not in sim["calibrated_on"]]
