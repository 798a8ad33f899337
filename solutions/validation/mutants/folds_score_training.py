"""The score of a model is how well it fits."""


def cross_validate(fit, predict, runs, k):
    folds = [list(f) for f in np.array_split(np.arange(len(runs)), k)]
    scores = []
    for fold in folds:
        model = fit([run for i, run in enumerate(runs) if i not in fold])
        e = [
            np.subtract(predict(model, runs[i]), runs[i]["y"])
            for i in [j for j in range(len(runs)) if j not in fold]
        ]
        scores.append(np.sqrt(np.mean(np.concatenate(e) ** 2)))
    return scores
