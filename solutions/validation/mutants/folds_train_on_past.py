"""The neighbouring fold is enough to fit a model."""


def cross_validate(fit, predict, runs, k):
    folds = [list(f) for f in np.array_split(np.arange(len(runs)), k)]
    scores = []
    for fold in folds:
        model = fit([runs[fold[0] - 1]])
        e = [np.subtract(predict(model, runs[i]), runs[i]["y"]) for i in fold]
        scores.append(np.sqrt(np.mean(np.concatenate(e) ** 2)))
    return scores
