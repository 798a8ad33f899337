"""``course report collisions``: your two simulations beside the exact answers and beside pymunk."""

from __future__ import annotations

import math

import numpy as np

from course.scoring import kit

bundles = kit.companion("collisions", "bundles")
engine = bundles.engine


def report(submission):
    """Three parts: the head-on pair, the drop, and both against pymunk."""
    parts = (
        ("Head on: the example", _head_on),
        ("The drop", _drop),
        ("Head on, and pymunk", _pymunk_head_on),
        ("The drop, and pymunk", _pymunk_drop),
    )
    return kit.Report(
        title="Your simulations, the exact answers and a real engine",
        sections=tuple(
            kit.guarded_section(title, lambda make=make, title=title: make(submission, title))
            for title, make in parts
        ),
    )


def _head_on_samples(submission, scene, t_end, h):
    value = submission.call(bundles.HEAD_ON, *scene.args(t_end, h))
    return bundles.samples(value, t_end, h, ("t", "x", "v"), scene.shown(t_end, h), 2)


def _as_it_comes(value):
    """t, x and v of any number of samples: a program that is not mended yet is worth seeing too."""
    t, x, v = kit.as_tuple(value, ("t", "x", "v"))
    t = kit.as_vector(t, None, "t")
    kit.expect_true(len(t) > 0, "The simulation returns no samples.")
    return t, kit.as_array(x, (len(t), 2), "x"), kit.as_array(v, (len(t), 2), "v")


def _drop_samples(submission, scene, t_end, h):
    value = submission.call(bundles.DROP, *scene.args(t_end, h))
    return bundles.samples(value, t_end, h, ("t", "z", "v"), scene.shown(t_end, h))


# -- against the exact answers --------------------------------------------------------------------------


def _head_on(submission, title):
    t_end, h = 5.0, 0.01
    panels, rows = [], []
    cases = bundles.asked("head_on_mended", None)
    examples = zip(cases[:3], bundles.meetings(cases, "head_on_mended")[:3], strict=True)  # the README's pair
    for (scene, _, _), truth in examples:
        e = scene.restitution
        t, x, v = _as_it_comes(submission.call(bundles.HEAD_ON, *scene.args(t_end, h)))
        exact = np.linspace(0.0, t_end, 501)
        true, _ = scene.at(exact, truth.contact, truth.after)
        legend = e == 0.0  # in the panel that has room for it
        panels.append(
            kit.Panel(
                x_label="time / s",
                y_label="" if panels else "x / m",
                title=f"e = {e:g}",
                series=(
                    kit.Series("exact" * legend, exact, true[:, 0], quiet=True),
                    kit.Series("", exact, true[:, 1], quiet=True),
                    kit.Series("yours, left" * legend, t[::25], x[::25, 0], kind="points"),
                    kit.Series("yours, right" * legend, t[::25], x[::25, 1], kind="points"),
                ),
            )
        )
        rows.append(
            (
                f"{e:g}",
                f"{x[-1, 0]:.6f} m",
                f"{true[-1, 0]:.6f} m",
                f"{np.max(np.abs(v.sum(axis=1))):.2g} kg m/s",
                f"{0.5 * float(v[-1] @ v[-1]):.6f} J",
                f"{4 * e * e:.6f} J",
            )
        )
    return kit.Section(
        title,
        text="Two balls of 1 kg and radius 0.5 m start 10 m apart, at 2 m/s each. They must touch at 2.25 s. "
        "The momentum is zero from beginning to end, and of the 4 J a fraction of e squared is left. If "
        "your balls "
        "change sides, there was no contact between them.",
        columns=("e", "your last x1", "exact", "largest momentum", "energy left", "exact"),
        rows=tuple(rows),
        plot=kit.Plot(
            title="The head-on pair: your samples on the exact lines",
            description="Three panels of position over time, one for each restitution: the exact "
            "lines of both "
            "balls bend at 2.25 s, and the points of your program are drawn over them.",
            panels=tuple(panels),
            columns=3,
        ),
    )


def _drop(submission, title):
    cases = bundles.asked("drop_bounces", None)
    (scene, t_end, h), truth = cases[0], bundles.bounces(cases, "drop_bounces")[0]
    t, z, v = _drop_samples(submission, scene, t_end, h)
    fine = np.linspace(0.0, t_end, 2001)
    true, _ = scene.at(fine, truth.times, truth.speeds)
    contacts, speeds = truth.times, truth.speeds
    rows = []
    for hop, (start, speed) in enumerate(zip(contacts[:5], speeds[:5], strict=True), 1):
        flight = (t > start) & (t < start + 2 * speed / scene.g)
        # Between samples the top is reckoned from the state: height plus v²/2g.
        top = np.max(z[flight] + np.maximum(v[flight], 0.0) ** 2 / (2 * scene.g)) - scene.radius
        rows.append((str(hop), f"{start:.4f} s", f"{top:.4f} m", f"{speed**2 / (2 * scene.g):.4f} m"))
    rest = f"{contacts[-1]:.4f} s" if speeds[-1] == 0.0 else "not by the end"
    return kit.Section(
        title,
        text=f"A ball of radius 0.1 m falls from 1 m with e = 0.7. Each bounce has e squared, 0.49, of the "
        f"height of "
        "the one before. "
        f"With g h for the slowest bounce it comes to rest at about {rest}; at the end yours is "
        f"{z[-1] - scene.radius + 0.0:.2g} m above the floor, at {v[-1] + 0.0:.2g} m/s.",
        columns=("hop", "starts at", "your top above the floor", "exact"),
        rows=tuple(rows),
        plot=kit.Plot(
            title="The drop: your samples on the exact parabolas",
            description="Height over time: parabolas that shrink to the floor and end there, with "
            "the points of your program drawn over them.",
            panels=(
                kit.Panel(
                    x_label="time / s",
                    y_label="height of the centre / m",
                    series=(
                        kit.Series("exact", fine, true, quiet=True),
                        kit.Series("yours", t[::4], z[::4], kind="points"),
                        kit.Series("at rest", [], scene.radius, kind="level"),
                    ),
                ),
            ),
        ),
    )


# -- against pymunk -------------------------------------------------------------------------------------


def _pymunk_head_on(submission, title):
    cases = bundles.asked("head_on_pymunk", None)
    (scene, t_end, _), truth = cases[0], bundles.meetings(cases, "head_on_pymunk")[0]
    series, rows, seen = [], [], []
    for h in (0.02, 0.008, 0.004):
        t, x, _ = _head_on_samples(submission, scene, t_end, h)
        off = engine.head_on(scene, t_end, h)[:, 0] - x[:, 0]
        late = math.ceil(truth.contact / h - 1e-9) * h - truth.contact
        change = scene.v0[0] - truth.after[0]
        seen.append(
            f"{1000 * h:g} ms: at most {1000 * np.max(np.abs(off[t < truth.contact])):.2f} mm up to the "
            f"contact, {1000 * np.max(np.abs(off)):.2f} mm overall, {1000 * off[-1]:.2f} mm at the end"
        )
        series.append(kit.Series(f"h = {1000 * h:g} ms", t, 1000 * off))
        rows.append(
            (
                f"{1000 * h:g} ms",
                f"{1000 * late:.2f} ms",
                f"{1000 * change * late:.2f} mm",
                f"{1000 * off[-1]:.2f} mm",
                f"{1000 * change * h:.2f} mm",
            )
        )
    return kit.Section(
        title,
        text="Balls of 1 kg and 3 kg, e = 0.6, in pymunk and in your program. pymunk moves all bodies first "
        "and looks "
        "for overlaps afterwards, so the impact comes at the first sample after the contact. Until then the "
        "ball keeps "
        "its old velocity, and from then on it is off by the change of velocity times the delay.\n\n"
        'If your program is right, the columns "predicted difference" and "pymunk less yours" agree: '
        "you can predict "
        "another engine's error to the last digit.",
        columns=("step", "pymunk's delay", "predicted difference", "pymunk less yours", "at most"),
        rows=tuple(rows),
        plot=kit.Plot(
            title="pymunk's left ball less yours",
            description="Difference over time for three steps. " + "; ".join(seen) + ".",
            panels=(kit.Panel(x_label="time / s", y_label="difference / mm", series=tuple(series)),),
        ),
    )


def _pymunk_drop(submission, title):
    cases = bundles.asked("drop_pymunk", None)
    (scene, t_end, _), first = cases[0], bundles.bounces(cases, "drop_pymunk")[0].times[0]
    rows, series, seen = [], [], []
    for h in (0.008, 0.004, 0.002):
        n = round(t_end / h)
        t, z, _ = _drop_samples(submission, scene, n * h, h)
        off = engine.drop(scene, n * h, h)[:, 0] - z
        k = int(np.searchsorted(t, first)) - 1
        seen.append(
            f"{1000 * h:g} ms: {1000 * off[k]:.2f} mm before the first contact, "
            f"at most {1000 * np.max(np.abs(off)):.1f} mm overall"
        )
        rows.append(
            (
                f"{1000 * h:g} ms",
                f"{1000 * scene.g * h * t[k] / 2:.2f} mm",
                f"{1000 * off[k]:.2f} mm",
                f"{1000 * np.max(np.abs(off)):.1f} mm",
                f"{1000 * engine.drop_error(scene, h):.1f} mm",
            )
        )
        series.append(kit.Series(f"h = {1000 * h:g} ms", t, 1000 * off))
    return kit.Section(
        title,
        text="The same ball as above, up to its second contact. In the air pymunk's position is behind, "
        "by g h t/2. At the floor pymunk's ball bounces late: for a moment it is inside the floor, "
        "and the rebound "
        "starts from there. All these errors shrink with the step, and an exact flight has none of them.",
        columns=("step", "g h t/2 at the floor", "pymunk less yours there", "largest difference", "at most"),
        rows=tuple(rows),
        plot=kit.Plot(
            title="pymunk's ball less yours",
            description="Difference over time for three steps. " + "; ".join(seen) + ".",
            panels=(kit.Panel(x_label="time / s", y_label="difference / mm", series=tuple(series)),),
        ),
    )
