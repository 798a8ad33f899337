"""An error of exactly 1.96 sigma is not covered."""


def measures(pairs):
    """rmse, bias, lag and coverage over the samples of all pairs."""
    y, sigma, measured = (np.concatenate(column) for column in zip(*map(columns, pairs)))
    e = y - measured
    return {
        "rmse": float(np.sqrt(np.mean(e**2))),
        "bias": float(np.mean(e)),
        "lag_s": best_shift(pairs),
        "coverage": float(np.mean(np.abs(e) < 1.96 * sigma)),
    }
