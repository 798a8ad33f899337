"""``course report integrators``: your four steps on a spring: their paths, energy, order and stability."""

from __future__ import annotations

import math

import numpy as np

from course.physics import exact, invariants, systems
from course.scoring import kit

STEPS = {
    "explicit_euler_step": "explicit Euler",
    "semi_implicit_euler_step": "semi-implicit Euler",
    "velocity_verlet_step": "velocity Verlet",
    "rk4_step": "Runge-Kutta 4",
}

_SPRING = systems.Oscillator(omega=2.0)
#: At this z = h omega every method shows what it does within a few turns.
_PHASE_Z, _PHASE_STEPS = 0.85, 60
#: A path that has gone so far out, in units of where it started, has shown what it does.
_PAPER = 2.2
_ENERGY_Z, _ENERGY_STEPS = 0.5, 1000
#: Round-off is far below the errors of all of these.
_ORDER_COUNTS, _ORDER_END = (160, 320, 640, 1280), 5.0
#: None of them is 2, where round-off would decide which of two methods with that limit grows.
_ZS = 0.01 + 0.02 * np.arange(160)
#: A growth within this of one is round-off: the limit that ``max_stable_step`` is asked for.
_GROWS = 1.0 + 1e-8


def report(submission):
    """Four parts, each about all of the steps that are written."""
    parts = (
        ("Phase: position and velocity", _phase),
        ("Energy", _energy),
        ("Order", _order),
        ("Stability", _stability),
    )
    return kit.Report(
        title="Your four steps on a spring",
        sections=tuple(
            kit.guarded_section(title, lambda make=make, title=title: make(submission, title))
            for title, make in parts
        ),
    )


def _each(submission, marches):
    """(t, q, p) of each march for each step that can be run, p being v / omega; and what keeps the others."""
    found, kept = {}, []
    for task, name in STEPS.items():
        try:
            paths = submission.march_each(task, marches)
        except (kit.StudentFailure, kit.CheckFailed) as failure:
            kept.append(f"- {name}: {kit.finding_for(failure).message}")
            continue
        found[task] = [(t, q[:, 0], v[:, 0] / _SPRING.omega) for t, q, v in paths]
    return found, ("\n\n" + "\n".join(kept) if kept else "")


def _spring(z, n, q0=1.0, p0=0.0):
    return _SPRING, [q0], [p0 * _SPRING.omega], z / _SPRING.omega, n, 0.0


def _until(gone):
    """How many samples there are up to and including the first that is gone."""
    return int(np.argmax(gone)) + 1 if np.any(gone) else len(gone)


def _phase(submission, title):
    found, kept = _each(submission, [_spring(_PHASE_Z, _PHASE_STEPS)])
    turn = np.linspace(0.0, 2.0 * math.pi, 200)
    panels, rows = [], []
    for task, ((_, q, p),) in found.items():
        far = np.hypot(q, p)
        shown = slice(_until(~(far < _PAPER)))
        panels.append(
            kit.Panel(
                x_label="position / m",
                y_label="velocity / ω / m",
                title=STEPS[task],
                equal=True,
                series=(
                    kit.Series("exact", np.cos(turn), np.sin(turn), quiet=True),
                    kit.Series("yours", q[shown], p[shown], kind="points"),
                ),
            )
        )
        rows.append((STEPS[task], f"{far[-1]:.4g} m", f"{np.min(far):.4g} m", f"{np.max(far):.4g} m"))
    return kit.Section(
        title,
        text=f"From rest at 1 m, {_PHASE_STEPS} steps of {_PHASE_Z:g} / ω. The exact motion is the circle "
        "of radius 1 m. Which of your paths close, and what shape do they have?" + kept,
        columns=("step", "distance from the centre at the end", "least", "largest"),
        rows=tuple(rows),
        plot=_plot(
            panels,
            "Your steps in the phase plane, on the exact circle",
            "Velocity over position, a panel for each step, with the exact circle. Largest distance from the "
            "centre: " + "; ".join(f"{name} {most}" for name, _, _, most in rows) + ".",
            columns=2,
        ),
    )


def _energy(submission, title):
    found, kept = _each(submission, [_spring(_ENERGY_Z, _ENERGY_STEPS)])
    series, rows = [], []
    for task, ((_, q, p),) in found.items():
        with np.errstate(over="ignore", invalid="ignore"):
            off = np.abs(invariants.relative_change(q * q + p * p))
            worst = np.maximum.accumulate(off)[1:]
        seen = slice(_until(~(worst < 1e3)))
        steps = np.arange(1, _ENERGY_STEPS + 1)
        drawn = worst[seen] > 0.0  # a logarithmic axis has no place for none
        series.append(kit.Series(STEPS[task], steps[seen][drawn], worst[seen][drawn]))
        rows.append((STEPS[task], *(f"{worst[n - 1]:.3g}" for n in (10, 100, _ENERGY_STEPS))))
    panel = kit.Panel("steps taken", "largest energy error so far", tuple(series), log="xy")
    return kit.Section(
        title,
        text="The spring should keep the energy that it has at the start. The figure shows, for steps of "
        f"{_ENERGY_Z:g} / ω, the largest error so far as a share of this energy. If a curve turns flat, "
        "the method bounds the energy; if it climbs, the method gains or loses energy with every "
        "step." + kept,
        columns=("step", "after 10 steps", "after 100", f"after {_ENERGY_STEPS}"),
        rows=tuple(rows),
        plot=_plot(
            [panel] if series else [],
            "Energy: which of your steps keep it?",
            "Largest energy error so far over steps, both axes logarithmic. At the end: "
            + "; ".join(f"{row[0]} {row[-1]}" for row in rows)
            + ".",
        ),
    )


def _order(submission, title):
    hs = np.array([_ORDER_END / n for n in _ORDER_COUNTS])
    found, kept = _each(
        submission, [_spring(h * _SPRING.omega, n) for h, n in zip(hs, _ORDER_COUNTS, strict=True)]
    )
    true, speed = exact.oscillator(_SPRING, [1.0], [0.0], _ORDER_END)
    series, rows = [], []
    for task, paths in found.items():
        errors = np.array(
            [math.hypot(q[-1] - true[0], p[-1] - speed[0] / _SPRING.omega) for _, q, p in paths]
        )
        usable = np.isfinite(errors) & (errors > 0.0)
        series.append(kit.Series(STEPS[task], hs[usable], errors[usable]))
        order = invariants.convergence_order(hs[usable], errors[usable]) if usable.sum() > 1 else math.nan
        rows.append((STEPS[task], f"{order + 0.0:.2f}", f"{errors[0]:.3g} m", f"{errors[-1]:.3g} m"))
    panel = kit.Panel("step / s", "error at 5 s / m", tuple(series), log="xy")
    return kit.Section(
        title,
        text="The error of position and velocity together after 5 s, against the closed form. An error that "
        "falls with the p-th power of the step is a straight line of slope p here: halve the step of a "
        "method of order p, and the error falls by 2 to the power p." + kept,
        columns=("step", "slope", f"error with {1000 * hs[0]:.4g} ms", f"with {1000 * hs[-1]:.4g} ms"),
        rows=tuple(rows),
        plot=_plot(
            [panel] if series else [],
            "Halve the step: how much smaller is the error?",
            "Error over step, both axes logarithmic: straight lines with slopes "
            + "; ".join(f"{name} {slope}" for name, slope, *_ in rows)
            + ".",
        ),
    )


def _stability(submission, title):
    starts = [_spring(float(z), 1, q0, p0) for z in _ZS for q0, p0 in ((1.0, 0.0), (0.0, 1.0))]
    found, kept = _each(submission, starts)
    series, rows = [], []
    for task, paths in found.items():
        ends = np.array([(q[-1], p[-1]) for _, q, p in paths]).reshape(len(_ZS), 2, 2)
        growth = np.array(
            [invariants.spectral_radius(one.T) if np.all(np.isfinite(one)) else math.nan for one in ends]
        )
        grows = ~(growth <= _GROWS)
        limit = f"{_ZS[int(np.argmax(grows))]:.2f}" if np.any(grows) else f"above {_ZS[-1]:g}"
        if grows[0]:
            limit = "the smallest tried" if np.isfinite(growth[0]) else "no numbers"
        # What grows faster would flatten the rest: its curve leaves the picture.
        series.append(kit.Series(STEPS[task], _ZS, np.where(growth <= 3.0, growth, math.nan)))
        rows.append((STEPS[task], limit))
    panel = kit.Panel(
        "step × ω", "growth per step", (*series, kit.Series("neither grows nor fades", [], 1.0, kind="level"))
    )
    return kit.Section(
        title,
        text="One step on a spring is a 2 by 2 matrix, and the largest modulus of its eigenvalues says by "
        "what the swing grows in every step. Above 1 it grows without end, however small its start." + kept,
        columns=("step", "first step × ω at which the swing grows"),
        rows=tuple(rows),
        plot=_plot(
            [panel] if series else [],
            "How large may a step be?",
            "Growth per step over step times ω. The swing begins to grow at: "
            + "; ".join(f"{name} {limit}" for name, limit in rows)
            + ".",
        ),
    )


def _plot(panels, title, description, columns=1):
    """The figure; None where no step could be run."""
    if not panels:
        return None
    return kit.Plot(title=title, description=description, panels=tuple(panels), columns=columns)
