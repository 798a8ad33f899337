"""The error of a run is stored where its measurement was."""


def cross_validate(fit, predict, runs, k):
    scores = []
    for fold in np.array_split(np.arange(len(runs)), k):
        model = fit([dict(run, y=run["y"].copy()) for i, run in enumerate(runs) if i not in fold])
        e = [np.subtract(predict(model, runs[i]), runs[i]["y"]) for i in fold]
        scores.append(np.sqrt(np.mean(np.concatenate(e) ** 2)))
    for run in runs:
        run["y"] -= np.mean(run["y"])
    return np.array(scores)
