"""Runs are told apart by ids, which they may not have."""


def cross_validate(fit, predict, runs, k):
    scores = []
    for held_out in np.array_split(np.arange(len(runs)), k):
        model = fit(
            [run for i, run in enumerate(runs) if run.get("id") not in [runs[j].get("id") for j in held_out]]
        )
        e = [np.subtract(predict(model, runs[i]), runs[i]["y"]) for i in held_out]
        scores.append(np.sqrt(np.mean(np.concatenate(e) ** 2)))
    return np.array(scores)
