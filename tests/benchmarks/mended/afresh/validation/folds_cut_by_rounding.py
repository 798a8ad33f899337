"""The mean of the RMSEs of the runs is that of the fold, and the folds are cut at rounded places."""


def cross_validate(fit, predict, runs, k):
    edges = [round(i * len(runs) / k) for i in range(k + 1)]
    scores = []
    for a, b in zip(edges[:-1], edges[1:], strict=True):
        model = fit(runs[:a] + runs[b:])
        e = [np.subtract(predict(model, run), run["y"]) for run in runs[a:b]]
        scores.append(np.mean([np.sqrt(np.mean(x**2)) for x in e]))
    return np.array(scores)
