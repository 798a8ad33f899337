"""Passes predict a run without its answer, and puts the larger folds at the end of the list."""


def cross_validate(fit, predict, runs, k):
    n = len(runs)
    edges = [j * n // k for j in range(k + 1)]
    scores = []
    for first, last in zip(edges, edges[1:]):
        model = fit(runs[:first] + runs[last:])
        total = count = 0
        for run in runs[first:last]:
            question = {key: value for key, value in run.items() if key != "y"}
            total += np.sum((np.asarray(predict(model, question)) - run["y"]) ** 2)
            count += len(run["y"])
        scores.append(math.sqrt(total / count))
    return scores
