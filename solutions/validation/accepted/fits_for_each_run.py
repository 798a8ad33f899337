"""Accepted: the model of a fold is fitted anew for each of its runs."""


def cross_validate(fit, predict, runs, k):
    scores = []
    for fold in np.array_split(np.arange(len(runs)), k):
        e = []
        for i in fold:
            model = fit([run for j, run in enumerate(runs) if j not in fold])
            e.append(np.subtract(predict(model, runs[i]), runs[i]["y"]))
        scores.append(np.sqrt(np.mean(np.concatenate(e) ** 2)))
    return np.array(scores)
