# The mean of the runs' own RMSEs.


def cross_validate(fit, predict, runs, k):
    scores = []
    for fold in np.array_split(np.arange(len(runs)), k):
        model = fit([run for i, run in enumerate(runs) if i not in fold])
        each = [np.sqrt(np.mean((predict(model, runs[i]) - runs[i]["y"]) ** 2)) for i in fold]
        scores.append(np.mean(each))
    return np.array(scores)
