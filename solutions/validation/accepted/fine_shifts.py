"""The lag on a grid of a twentieth of a sample, by interpolation of both signals' difference."""


def best_shift(pairs):
    shifts = np.arange(-0.25, 0.25, 0.002)
    coarse = shifts[np.argmin(misfit(pairs, shifts))]
    fine = coarse + np.arange(-0.002, 0.002, 0.0001)
    return float(fine[np.argmin(misfit(pairs, fine))])
