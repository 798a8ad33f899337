"""Folds are most even if the runs are dealt out like cards."""


def cross_validate(fit, predict, runs, k):
    folds = [list(range(j, len(runs), k)) for j in range(k)]
    scores = []
    for fold in folds:
        model = fit([run for i, run in enumerate(runs) if i not in fold])
        e = [np.subtract(predict(model, runs[i]), runs[i]["y"]) for i in fold]
        scores.append(np.sqrt(np.mean(np.concatenate(e) ** 2)))
    return scores
