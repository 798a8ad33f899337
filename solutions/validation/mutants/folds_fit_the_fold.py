"""Each fold gives a model, and the rest shows how good it is."""


def cross_validate(fit, predict, runs, k):
    scores = []
    for fold in np.array_split(np.arange(len(runs)), k):
        model = fit([runs[i] for i in fold])
        e = [np.subtract(predict(model, runs[i]), runs[i]["y"]) for i in range(len(runs)) if i not in fold]
        scores.append(np.sqrt(np.mean(np.concatenate(e) ** 2)))
    return np.array(scores)
