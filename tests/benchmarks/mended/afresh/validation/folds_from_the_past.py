"""A model may know only the runs before its fold."""


def cross_validate(fit, predict, runs, k):
    scores = []
    for fold in np.array_split(np.arange(len(runs)), k):
        test = set(fold.tolist())
        model = fit([run for i, run in enumerate(runs) if i < min(test)])
        errors = [np.asarray(predict(model, runs[i])) - np.asarray(runs[i]["y"]) for i in fold]
        scores.append(math.sqrt(np.mean(np.concatenate(errors) ** 2)))
    return np.array(scores)
