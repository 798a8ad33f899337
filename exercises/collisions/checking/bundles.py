"""What the public and the hidden checks of ``collisions`` share: reading answers, and expecting them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from course.scoring import kit

probes = kit.companion("collisions", "probes")
tracks = kit.companion("collisions", "tracks")
paths = kit.companion("collisions", "paths")
engine = kit.companion("collisions", "engine")
_questions = kit.companion("collisions", "questions")
named = kit.words("collisions")

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
    HEAD_ON: ("m", "x0", "v0", "radius", "restitution", "t_end", "h"),
    DROP: ("z0", "v0", "radius", "restitution", "g", "t_end", "h"),
}

#: What is right where one of the masses is infinite.
WALLS = {
    IMPULSE: "One over an infinite mass is zero. Where va > vb, J is (1 + e)(va - vb) times the other mass.",
    RESOLVE: "One over an infinite mass is zero: the wall keeps its velocity. That of the other body "
    "changes by (1 + e) s along n, and not at all across it.",
    FRICTION: "One over an infinite mass is zero: the wall keeps its velocity, and the other body gets J "
    "along n and Jt = min(mu J, |vt| times its mass) across it.",
}

ROUNDING = "rounding"
INSTANT = "the README's 1e-9 s for the instant of each contact, times the speeds; and rounding"

# -- what is asked, and what should come back -------------------------------------------------------------


def asked(check, draw):
    """The inputs of a public check: fixed ones at home (``draw`` is None), drawn ones in a grading run."""
    if draw is None:
        return _questions.FIXED[check]
    return kit.reference("collisions", "public").PUBLIC[check](draw)


def right(task, calls, check=""):
    """What the task gives for each of ``calls``; at home for the fixed inputs of ``check``."""
    formulas = kit.reference("collisions", "formulas")
    if formulas is not None:
        return [formulas.RIGHT[task](*args) for args in calls]
    return kit.known_answers("collisions", check)


def meetings(cases, check=""):
    """When the balls of each (scene, t_end, h) touch, and how they go on."""
    motions = kit.reference("collisions", "motions")
    if motions is not None:
        return [motions.meeting(scene) for scene, _, _ in cases]
    return [paths.Meeting(*known) for known in kit.known_answers("collisions", check)]


def bounces(cases, check=""):
    """The contacts of the ball of each (scene, t_end, h), a little beyond the end."""
    motions = kit.reference("collisions", "motions")
    if motions is not None:
        return [motions.bounces(scene, t_end + h, h) for scene, t_end, h in cases]
    return [paths.Bounces(*known) for known in kit.known_answers("collisions", check)]


def known():
    """What public checks expect for their fixed inputs, for ``course author build``."""
    reckon = {HEAD_ON: meetings, DROP: bounces}
    return {
        check: reckon[task](_questions.FIXED[check])
        if task in reckon
        else right(task, _questions.FIXED[check])
        for check, task in _questions.TASKS.items()
    }


# -- single calls ---------------------------------------------------------------------------------------


def shown(task, args):
    """The same as a finding shows them."""
    return dict(zip(_NAMES[task], args, strict=True))


def answers(submission, task, calls):
    """What the task returns for each of ``calls``: in one piece, as the formulas do, and as its parts."""
    try:
        values = submission.call_each(task, calls)
    except kit.StudentFailure as failure:
        if failure.kind == "error":
            _tell_dimension(submission, task, calls, failure)
        raise
    parts = [_parts(task, args, value) for args, value in zip(calls, values, strict=True)]
    return [found[0] if len(found) == 1 else found for found in parts], parts


def _tell_dimension(submission, task, calls, failure):
    """Where calls work with vectors of one length and fail with those of another, say so."""
    by_size = {}
    for args in calls:
        if sizes := {len(arg) for arg in args if isinstance(arg, np.ndarray)}:
            by_size.setdefault(sizes.pop(), []).append(args)
    works = {
        d: kit.attempt(lambda some=some: submission.call_each(task, some)) for d, some in by_size.items()
    }
    good = [d for d, found in works.items() if found is not None]
    fails = lambda args: kit.attempt(lambda: submission.call_each(task, [args])) is None  # noqa: E731
    bad = [d for d, found in works.items() if found is None and all(map(fails, by_size[d]))]
    if good and bad:
        kit.fail(
            f"In {bad[0]}-D your code raises an exception; in {good[0]}-D it works.",
            input=shown(task, by_size[bad[0]][0]),
            expected="a result",
            actual=failure.type,
            diagnose=named("ONE_DIMENSION_ONLY"),
        )


def _parts(task, args, value):
    if task == IMPULSE:
        return (kit.as_number(value, "the impulse"),)
    if task == MOMENT:
        if isinstance(value, bool | np.bool_):
            kit.fail(
                "The answer is True or False, and neither a time nor None.",
                help="Return the time of contact in s, or None where there is none.",
                input=shown(task, args),
                expected="a time in s, or None",
                actual=bool(value),
            )
        return (None if value is None else kit.as_number(value, "the time of impact"),)
    if task in (RESOLVE, FRICTION):
        return kit.as_pair(value, len(args[4]), ("va_next", "vb_next"))
    touching, normal, depth = kit.as_tuple(value, ("touching", "normal", "depth"))
    ranks = [kit.attempt(lambda part=part: np.ndim(part)) for part in (touching, normal, depth)]
    if ranks.count(1) == 1 and ranks[1] == 0:
        kit.fail(
            f"{task} returns its three results in another order.",
            input=shown(task, args),
            expected="(touching, normal, depth)",
            actual=f"the normal is number {ranks.index(1) + 1} of three",
            diagnose=named("RESULTS_IN_OTHER_ORDER"),
        )
    if isinstance(normal, np.ndarray) and normal.ndim == 1 and len(normal) in {1, 2, 3} - {len(args[0])}:
        kit.fail(
            "The normal has another number of coordinates than the centre.",
            input=shown(task, args),
            expected=f"{len(args[0])} coordinates",
            actual=len(normal),
            diagnose=named("ONE_DIMENSION_ONLY"),
        )
    return (
        kit.as_bool(touching, "touching"),
        kit.as_vector(normal, len(args[0]), "normal"),
        kit.as_number(depth, "depth"),
    )


def expect_public(submission, task, check, draw, message, help=""):
    """``expect_formula`` on the inputs of a public check."""
    expect_formula(submission, task, asked(check, draw), message, help, check=check)


def expect_formula(submission, task, calls, message, help="", check=""):
    """Every answer is what the contract's formula gives."""
    values, parts = answers(submission, task, calls)
    truth = right(task, calls, check)

    def diagnose():
        return probes.of_calls(task, calls, values, truth)

    for args, found, wanted in zip(calls, parts, truth, strict=True):
        finding = {"input": shown(task, args), "message": message, "help": help, "diagnose": diagnose}
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


def expect_one_centre(submission, calls):
    """Spheres whose centres coincide touch, and have any unit vector for a normal."""
    values, parts = answers(submission, SPHERES, calls)
    truth = [(True, np.eye(1, len(xa))[0], ra + rb) for xa, ra, _, rb in calls]
    for args, (touching, normal, depth) in zip(calls, parts, strict=True):
        finding = {
            "input": shown(SPHERES, args),
            "message": "Where two centres coincide, the result is wrong.",
            "help": "They touch, as deep as the sum of the radii; any unit vector will do for the normal.",
            "diagnose": lambda: probes.of_calls(SPHERES, calls, values, truth),
        }
        length = float(np.sqrt(normal @ normal))
        kit.expect_close(length, 1.0, abs=1e-9, source=ROUNDING, quantity="length of the normal", **finding)
        expect_contact((touching, normal, depth), (True, normal, args[1] + args[3]), finding)


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


def expect_walls(submission, task, check, draw):
    """``expect_formula`` for bodies of infinite mass."""
    expect_public(
        submission,
        task,
        check,
        draw,
        "With a body of infinite mass (a wall) the result is wrong.",
        WALLS[task],
    )


def expect_kept(submission, task, args):
    """A call leaves its arguments as they were. Handing back the very arrays is allowed."""
    inspected = submission.call_inspect(task, *args)
    names = _NAMES[task]
    kept = [name if isinstance(arg, np.ndarray) else "" for name, arg in zip(names, args, strict=True)]
    kit.expect_untouched(
        args,
        replace(inspected, shared=False),
        names=kept,
        mutated=named("MUTATES_INPUT"),
        shared=named("MUTATES_INPUT"),
        input=shown(task, args),
    )
    return inspected.value


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
            message="The number of samples is not N + 1, with N = round(t_end / h).",
            help="Take N = round(t_end / h) steps: row 0 is the initial state, and each step adds a row.",
            diagnose=lambda rows=rows: tracks.of_count(len(kit.as_list(rows)), t_end, h, (t, x, v)),
        )
    t = kit.as_array(t, (n + 1,), names[0])
    shape = (n + 1,) if width is None else (n + 1, width)
    x, v = (kit.as_array(a, shape, name) for a, name in zip((x, v), names[1:], strict=True))
    kit.expect_array(
        t,
        h * np.arange(n + 1),
        abs=1e-9,
        source="the README's 1e-9 s",
        quantity="t",
        units="s",
        input=given,
        message="The times are not 0, h, 2h, ... up to t_end.",
        help="The time of sample i is i * h.",
        diagnose=lambda: tracks.of_times(t, h),
    )
    return t, x, v


@np.errstate(all="ignore")  # a student may return anything
def expect_head_on(scene, truth, value, t_end, h, message, help=""):
    """A head-on pair moves as the closed form says, at every sample. truth: ``paths.Meeting``."""
    given = scene.shown(t_end, h)
    t, x, v = samples(value, t_end, h, ("t", "x", "v"), given, 2)
    x_true, v_true = scene.at(t, truth.contact, truth.after)
    # On the instant of contact itself either velocity is right.
    v_true = np.where(np.abs(t - truth.contact)[:, None] < 1e-7, v, v_true)
    speeds = 1 + float(np.max(np.abs([scene.v0, truth.after])))
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
            diagnose=lambda: tracks.of_head_on(scene, truth, t, x, v, h),
        )
    return t, x, v


# -- the drop -------------------------------------------------------------------------------------------


@np.errstate(all="ignore")  # a student may return anything
def expect_drop(scene, truth, value, t_end, h, message, help=""):
    """A ball falls, bounces and rests as the closed form says, at every sample. truth: ``paths.Bounces``."""
    given = scene.shown(t_end, h)
    t, z, v = samples(value, t_end, h, ("t", "z", "v"), given)
    z_true, v_true = scene.at(t, truth.times, truth.speeds)
    contacts = np.array([*truth.times, truth.must])
    near = np.any(np.abs(t[:, None] - contacts) < 1e-7, axis=1)
    tolerance = 2e-9 * (1 + scene.fastest) * len(contacts)
    # Between the two readings of the rule both the floor and one hop more are right.
    between = (t > truth.may - 1e-7) & (t < truth.must + 1e-7)
    z_hop, v_hop = scene.at(t, truth.times, paths.hopping(scene, truth))
    hops = between & (np.abs(z - z_hop) <= tolerance)
    lies = between & (np.abs(z - scene.radius) <= tolerance)
    still = lies & (np.abs(v) <= tolerance)
    v_true = np.where(hops & ~still, v_hop, np.where(lies, 0.0, v_true))
    for actual, wanted, free, name, units in (
        (z, z_true, hops | lies, "z", "m"),
        (v, v_true, near, "v", "m/s"),
    ):
        kit.expect_array(
            actual,
            np.where(free, actual, wanted),
            abs=tolerance,
            source=INSTANT,
            quantity=name,
            units=units,
            t=t,
            input=given,
            message=message,
            help=help,
            diagnose=lambda: tracks.of_drop(scene, truth, t, z, v, h),
        )
    return t, z, v
