"""The lag on a grid of a twentieth of a sample, by interpolation of both signals' difference."""


def best_shift(pairs):
    shifts = np.arange(-0.25, 0.25, 0.002)
    coarse = shifts[int(np.argmin([misfit(pairs, s) for s in shifts]))]
    fine = coarse + np.arange(-0.002, 0.002, 0.0001)
    return float(fine[int(np.argmin([misfit(pairs, s) for s in fine]))])
