"""Shows a student's reports of the three known engines beside the truth, and how their errors shrink."""

from __future__ import annotations

import itertools

import numpy as np

from course.scoring import kit

bench = kit.companion("engine-comparison", "bench")
boxes = kit.companion("engine-comparison", "boxes")
measured = kit.companion("engine-comparison", "measured")
probing = kit.companion("engine-comparison", "probing")

THREE = {"anvil": boxes.ANVIL, "balsa": boxes.BALSA, "cork": boxes.CORK}


def report(submission):
    """Your reports and the truth, error against step, and your choices among the real engines."""
    return kit.Report(
        title="Three engines, as you measured them",
        sections=(
            kit.guarded_section("Your reports beside the truth", lambda: _table(submission)),
            _convergence(submission),
            kit.guarded_section("Your choices among real engines", lambda: _choices(submission)),
        ),
    )


def _cases(submission):
    return bench.cases(
        submission,
        "public",
        lambda: [bench.Case(name, box, boxes.TRUTH[name]) for name, box in THREE.items()],
    )


def _table(submission):
    found = _cases(submission)
    judged = bench.reported(found, len(found) - 1)
    rows = []
    for key in bench.KEYS:
        cells = []
        for case in judged:
            value = case.measured(key)
            mark = "" if value is None or _right(key, case) else " (!)"
            cells.append(f"{_shown(value)}{mark} / {_shown(case.truth[key])}")
        rows.append((key, *cells))
    runs = ", ".join(f"{len(case.runs)} for {case.name}" for case in judged)
    names = [case.name for case in judged]
    text = (
        "For each engine: what you found / what is true. A (!) marks what differs by more than a check "
        f"allows. Runs it took you: {runs}."
    )
    return kit.Section("Your reports beside the truth", text, columns=("key", *names), rows=tuple(rows))


def _number(value):
    """A student's value as a float, as large as it may be; None if it is no number."""
    return kit.attempt(lambda: kit.as_number(value))


def _right(key, case):
    value = case.measured(key)
    if isinstance(value, bool | None):
        return value is not None and key not in probing.TOLERANCES and value == case.truth[key]
    number = _number(value)
    if number is None:
        return False
    return bool(probing.right(key, bench.Case(case.name, case.box, case.truth, report={key: number})))


def _shown(value):
    if value is None:
        return "not yet"
    if isinstance(value, bool | str):
        return str(value)
    number = _number(value)
    return "?" if number is None else f"{number + 0.0:.4g}"  # no "-0"


def _convergence(submission):
    """How far each engine's end of a spring run is from its own limit, and the order you reported."""
    found = kit.attempt(lambda: _cases(submission)) or []
    orders = {case.name: _number(case.measured("order")) for case in found}
    series = []
    for name, box in THREE.items():
        hs, gaps = _gaps(box)
        order = orders.get(name)
        known = order is not None and abs(order) < 12
        series.append(
            kit.Series(f"{name}, order {order:g} as you say" if known else name, hs, gaps, kind="points")
        )
        if known:
            series.append(kit.Series("", hs, [gaps[0] * (h / hs[0]) ** order for h in hs], quiet=True))
    panel = kit.Panel("h omega", "change when h is halved", tuple(series), log="xy")
    plot = kit.Plot(
        title="The slope of the points is the order",
        description="A doubly logarithmic panel with a row of points for each engine. They fall with the "
        "step: by a factor of four at each halving for anvil, of two for balsa, of sixteen for cork. A grey "
        "line has the slope of the order you report; where that is right it runs through the points.",
        panels=(panel,),
    )
    text = (
        "Each point compares a spring run with the same run at half the step, so that damping does not count."
    )
    return kit.Section("How the error shrinks with the step", text, plot=plot)


def _gaps(box):
    """Steps times omega, and the distance between the ends of runs with n and 2n steps."""
    counts = [4 * 2**k for k in range(7)]
    ends = []
    for n in counts:
        q, v = box.run("spring", [1.0], [0.7 * box.omega], 1.3 / box.omega / n, n, [0.0])
        ends.append(np.array([q[-1, 0], v[-1, 0] / box.omega]))
    gaps = [float(np.linalg.norm(a - b)) for a, b in itertools.pairwise(ends)]
    return [1.3 / n for n in counts[:-1]], gaps


def _choices(submission):
    answers = submission.call_each(
        "choose_engine", [(measured.reports(), needs) for needs, _ in measured.QUESTIONS.values()]
    )
    rows = []
    for (job, (needs, _)), answer in zip(measured.QUESTIONS.items(), answers, strict=True):
        wanted = ", ".join(f"{need['key']} {need['op']} {_shown(need['value'])}" for need in needs)
        rows.append((job, wanted, _shown(answer)))
    text = "The engines are those of the lesson, each as it comes and well set. The cost is processor time."
    return kit.Section(
        "Your choices among real engines", text, columns=("for", "required", "you chose"), rows=tuple(rows)
    )
