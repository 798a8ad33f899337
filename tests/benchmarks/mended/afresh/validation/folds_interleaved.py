"""Every k-th run into the same fold, as one deals cards."""


def cross_validate(fit, predict, runs, k):
    scores = []
    for i in range(k):
        test = runs[i::k]
        train = [run for j, run in enumerate(runs) if j % k != i]
        model = fit(train)
        errors = np.concatenate([np.asarray(predict(model, r)) - r["y"] for r in test])
        scores.append(np.sqrt(np.mean(errors**2)))
    return np.array(scores)
