"""Fits all models before it predicts anything, starting with the last fold."""


def cross_validate(fit, predict, runs, k):
    folds = [list(fold) for fold in np.array_split(range(len(runs)), k)]
    models = {}
    for j in reversed(range(k)):
        models[j] = fit([runs[i] for i in range(len(runs)) if i not in folds[j]])
    return [
        np.sqrt(np.mean(np.concatenate([predict(models[j], runs[i]) - runs[i]["y"] for i in folds[j]]) ** 2))
        for j in range(k)
    ]
