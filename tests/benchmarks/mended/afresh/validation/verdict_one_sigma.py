"""y_sim plus or minus sigma."""


def measures(pairs):
    e, inside = [], []
    for s, r in pairs:
        y, real = np.asarray(s["y"]), np.asarray(r["y"])
        e.append(y - real)
        inside.append(np.abs(y - real) <= np.asarray(s["sigma"]))
    e, inside = np.concatenate(e), np.concatenate(inside)
    return {
        "rmse": float(np.sqrt(np.mean(e**2))),
        "bias": float(np.mean(e)),
        "lag_s": best_shift(pairs),
        "coverage": float(np.mean(inside)),
    }
