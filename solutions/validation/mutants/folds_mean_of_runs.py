"""The mean of the RMSEs of the runs is the RMSE of the fold."""


def cross_validate(fit, predict, runs, k):
    folds = [list(f) for f in np.array_split(np.arange(len(runs)), k)]
    scores = []
    for fold in folds:
        model = fit([run for i, run in enumerate(runs) if i not in fold])
        e = [np.subtract(predict(model, runs[i]), runs[i]["y"]) for i in fold]
        scores.append(np.mean([np.sqrt(np.mean(x**2)) for x in e]))
    return scores
