"""A maximum-length sequence from a shift register, without numpy and without the generator, as a tuple."""


def design_excitation(budget_s, u_max, rng):
    bits, out = [1] * 9, []
    while len(out) < round(100 * budget_s):
        out += [u_max if bits[-1] else -u_max] * 15
        bits = [bits[8] ^ bits[4], *bits[:8]]
    return tuple(float(x) for x in out[: round(100 * budget_s)])
