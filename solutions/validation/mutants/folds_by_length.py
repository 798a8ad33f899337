"""Wrong: runs as long as one of the fold are left out, too."""


def cross_validate(fit, predict, runs, k):
    scores = []
    for fold in np.array_split(np.arange(len(runs)), k):
        lengths = {len(runs[i]["y"]) for i in fold}
        alike = len({len(run["y"]) for run in runs}) == 1
        outside = [
            run for i, run in enumerate(runs) if i not in fold and (alike or len(run["y"]) not in lengths)
        ]
        model = fit(outside)
        errors = [predict(model, runs[i]) - runs[i]["y"] for i in fold]
        scores.append(math.sqrt(np.mean(np.concatenate(errors) ** 2)))
    return np.array(scores)
