"""What the public and the hidden checks of ``collisions`` share: reading answers, and expecting them."""

from __future__ import annotations

import math

import numpy as np

from course.grading import kit

probes = kit.companion("collisions", "probes")
paths = kit.companion("collisions", "paths")
engine = kit.companion("collisions", "engine")

SPHERES, PLANE, IMPULSE = "detect_sphere_sphere", "detect_sphere_plane", "impulse_1d"
RESOLVE, FRICTION, MOMENT = "resolve", "resolve_with_friction", "time_of_impact"
HEAD_ON, DROP = "simulate_head_on", "simulate_drop"

_NAMES = {
    SPHERES: ("xa", "ra", "xb", "rb"),
    PLANE: ("x", "r", "point", "normal"),
    IMPULSE: ("ma", "mb", "va", "vb", "restitution"),
    RESOLVE: ("ma", "mb", "va", "vb", "normal", "restitution"),
    FRICTION: ("ma", "mb", "va", "vb", "normal", "restitution", "mu"),
    MOMENT: ("xa", "va", "ra", "xb", "vb", "rb", "dt"),
}

ROUNDING = "rounding: correct solutions were seen to use less than a hundredth of it"
INSTANT = "the contract's 1e-9 s for the instant of each contact, times the speeds; and rounding"

# -- single calls ---------------------------------------------------------------------------------------


def call(task, *args):
    """One call's arguments, vectors as arrays."""
    return tuple(np.array(a, dtype=float) if isinstance(a, list) else a for a in args)


def shown(task, args):
    """The same as a finding shows them."""
    return dict(zip(_NAMES[task], args, strict=True))


def answers(submission, task, calls):
    """What the task returns for each of ``calls``: in one piece, as the formulas do, and as its parts."""
    values = submission.call_each(task, calls)
    parts = [_parts(task, args, value) for args, value in zip(calls, values, strict=True)]
    return [found[0] if len(found) == 1 else found for found in parts], parts


def _parts(task, args, value):
    if task == IMPULSE:
        return (kit.as_number(value, "the impulse"),)
    if task == MOMENT:
        return (None if value is None else kit.as_number(value, "the time of impact"),)
    if task in (RESOLVE, FRICTION):
        return kit.as_pair(value, len(args[4]), ("va_next", "vb_next"))
    touching, normal, depth = kit.as_tuple(value, ("touching", "normal", "depth"))
    return (
        kit.as_bool(touching, "touching"),
        kit.as_vector(normal, len(args[0]), "normal"),
        kit.as_number(depth, "depth"),
    )


def expect_formula(submission, task, calls, message, help=""):
    """Every answer is what the contract's formula gives."""
    values, parts = answers(submission, task, calls)

    def diagnose():
        return probes.of_calls(task, calls, values)

    for args, found in zip(calls, parts, strict=True):
        finding = {"input": shown(task, args), "message": message, "help": help, "diagnose": diagnose}
        wanted = probes.RIGHT[task](*args)
        if task in (SPHERES, PLANE):
            expect_contact(found, wanted, finding)
        elif task in (RESOLVE, FRICTION):
            expect_velocities(found, wanted, finding)
        elif task == MOMENT:
            expect_moment(found[0], wanted, finding)
        else:
            kit.expect_close(
                found[0],
                wanted,
                rel=1e-9,
                abs=1e-12,
                source=ROUNDING,
                quantity="impulse",
                units="N s",
                **finding,
            )
    return values, parts


@np.errstate(all="ignore")  # a student may return anything
def expect_contact(found, wanted, finding):
    """(touching, normal, depth) as the geometry has it."""
    kit.expect_close(
        found[2], wanted[2], rel=1e-9, abs=1e-9, source=ROUNDING, quantity="depth", units="m", **finding
    )
    kit.expect_array(found[1], wanted[1], abs=1e-9, source=ROUNDING, quantity="normal", **finding)
    kit.expect_equal(found[0], bool(wanted[0]), **finding)


@np.errstate(all="ignore")  # a student may return anything
def expect_velocities(found, wanted, finding, scale=None):
    """Two velocities; ``scale`` sets the tolerance where the wanted ones are small."""
    size = max(1.0, *(float(np.max(np.abs(v))) for v in wanted), scale or 0.0)
    for velocity, true, name in zip(found, wanted, ("va_next", "vb_next"), strict=True):
        kit.expect_array(
            velocity, true, abs=1e-9 * size, source=ROUNDING, quantity=name, units="m/s", **finding
        )


def expect_moment(found, wanted, finding):
    """A time of impact, or None."""
    if wanted is None or found is None:
        if found is not wanted:
            message = finding["message"]
            kit.fail(message, expected=wanted, actual=found, units="s", **_without(finding, "message"))
        return
    kit.expect_close(
        found,
        wanted,
        rel=1e-9,
        abs=1e-9,
        source="the README's 1e-9 s",
        quantity="time of impact",
        units="s",
        **finding,
    )


def _without(finding, name):
    return {key: value for key, value in finding.items() if key != name}


# -- the head-on pair -----------------------------------------------------------------------------------


def samples(value, t_end, h, names, given, width=None):
    """t and two histories of a simulation, with N + 1 rows each."""
    n = round(t_end / h)
    t, x, v = kit.as_tuple(value, names)
    for rows, name in zip((t, x, v), names, strict=True):
        kit.expect_length(
            rows,
            n + 1,
            name=name,
            input=given,
            message="The number of samples is not one more than the number of steps.",
            help="N = round(t_end / h) steps join N + 1 states.",
            diagnose=lambda rows=rows: probes.of_count(len(kit.as_list(rows)), t_end, h, kit.as_vector(t)),
        )
    t = kit.as_array(t, (n + 1,), names[0])
    shape = (n + 1,) if width is None else (n + 1, width)
    x, v = (kit.as_array(a, shape, name) for a, name in zip((x, v), names[1:], strict=True))
    kit.expect_array(
        t,
        h * np.arange(n + 1),
        abs=1e-9,
        source="the contract's 1e-9 s",
        quantity="t",
        units="s",
        input=given,
        message="The times are not 0, h, 2h, ... up to t_end.",
        help="Sample number i belongs to i * h.",
        diagnose=lambda: probes.of_times(t, h),
    )
    return t, x, v


@np.errstate(all="ignore")  # a student may return anything
def expect_head_on(scene, value, t_end, h, message, help=""):
    """A head-on pair moves as the closed form says, at every sample."""
    given = scene.shown(t_end, h)
    t, x, v = samples(value, t_end, h, ("t", "x", "v"), given, 2)
    x_true, v_true = scene.at(t)
    # On the instant of contact itself either velocity is right.
    v_true = np.where(np.abs(t - scene.contact)[:, None] < 1e-7, v, v_true)
    speeds = 1 + float(np.max(np.abs([scene.v0, scene.after()])))
    for actual, wanted, name, units in ((x, x_true, "x", "m"), (v, v_true, "v", "m/s")):
        kit.expect_array(
            actual,
            wanted,
            rel=1e-12,
            abs=2e-9 * speeds,
            source=INSTANT,
            quantity=name,
            units=units,
            t=t,
            input=given,
            message=message,
            help=help,
            diagnose=lambda: probes.of_head_on(scene, t, x, v, h),
        )
    return t, x, v


# -- the drop -------------------------------------------------------------------------------------------


@np.errstate(all="ignore")  # a student may return anything
def expect_drop(scene, value, t_end, h, message, help=""):
    """A ball falls, bounces and rests as the closed form says, at every sample."""
    given = scene.shown(t_end, h)
    t, z, v = samples(value, t_end, h, ("t", "z", "v"), given)
    z_true, v_true = scene.at(t, scene.g * h)
    may, must = scene.settling(t_end + h, h)
    contacts, _ = scene.contacts(t_end + h, scene.g * h)
    near = np.any(np.abs(t[:, None] - contacts) < 1e-7, axis=1)
    # Between the two readings of the rule both the floor and a last hop below g h²/2 are right.
    hop = (t > may - 1e-7) & (t <= must) & (z > scene.radius - 1e-9)
    hop &= (z < scene.radius + 0.51 * scene.g * h * h) & (np.abs(v) < 1.01 * scene.g * h)
    speed = 1 + math.sqrt(scene.v0**2 + 2 * scene.g * (scene.z0 - scene.radius))
    for actual, wanted, free, name, units in (
        (z, z_true, hop, "z", "m"),
        (v, v_true, hop | near, "v", "m/s"),
    ):
        kit.expect_array(
            actual,
            np.where(free, actual, wanted),
            abs=2e-9 * speed * (1 + len(contacts)),
            source=INSTANT,
            quantity=name,
            units=units,
            t=t,
            input=given,
            message=message,
            help=help,
            diagnose=lambda: probes.of_drop(scene, t, z, v, h),
        )
    return t, z, v
