"""Laws that the hidden graders of ``collisions`` hold an impact to: what is kept, and what may not matter."""

from __future__ import annotations

import numpy as np

from course.scoring import kit

bundles = kit.companion("collisions", "bundles")
draws = kit.reference("collisions", "draws")
probes = bundles.probes


def _impacts(submission, task, calls):
    """Answers to ``calls``, and a function that looks for the mistake behind all of them."""
    values, parts = bundles.answers(submission, task, calls)
    return parts, lambda: probes.of_calls(task, calls, values, bundles.right(task, calls))


def _speeds(args):
    """The largest speed in a scene, m/s, which sets what rounding can do."""
    return float(max(np.abs(args[2]).max(), np.abs(args[3]).max()))


@np.errstate(all="ignore")
def _expect_response(args, found, finding):
    """Bodies that approached no longer do: there was an impact at all."""
    n = args[4]
    closing = float((found[0] - found[1]) @ n)
    kit.expect_bounded(
        closing,
        high=1e-9 * (1 + _speeds(args)),
        source=bundles.ROUNDING,
        quantity="speed of approach afterwards",
        units="m/s",
        **(
            finding
            | {
                "message": "Bodies that run into each other still approach after the impact.",
                "help": "After the impact, (va - vb) . n is -e times what it was before.",
            }
        ),
    )


def _finding(task, args, message, help, diagnose):  # noqa: A002 - the field's name
    return {"input": bundles.shown(task, args), "message": message, "help": help, "diagnose": diagnose}


@np.errstate(all="ignore")
def expect_momentum(submission, task, calls):
    """The total momentum is kept, and something happens."""
    parts, diagnose = _impacts(submission, task, calls)
    for args, found in zip(calls, parts, strict=True):
        finding = _finding(
            task,
            args,
            "The total momentum changes, although no outside force acts.",
            "What b gains, a loses.",
            diagnose,
        )
        _expect_momentum(args, found, finding)
        _expect_response(args, found, finding)


@np.errstate(all="ignore")
def _expect_momentum(args, found, finding):
    ma, mb = args[:2]
    kit.expect_array(
        probes.momentum(ma, mb, *found),
        probes.momentum(*args[:4]),
        abs=1e-9 * (ma + mb) * (1 + _speeds(args)),
        source=bundles.ROUNDING,
        quantity="momentum",
        units="kg m/s",
        **finding,
    )


@np.errstate(all="ignore")
def expect_parting(submission, calls):
    """Newton's rule along the normal; across it nothing."""
    task = bundles.RESOLVE
    parts, diagnose = _impacts(submission, task, calls)
    for args, (va_next, vb_next) in zip(calls, parts, strict=True):
        _, _, va, vb, n, e = args
        finding = _finding(
            task,
            args,
            "Bodies do not part as they should: at e times the speed of approach along the normal, and with "
            "the same slip across it.",
            "(va - vb) . n becomes -e times what it was, and across the normal nothing changes.",
            diagnose,
        )
        slip = (vb - va) - ((vb - va) @ n) * n
        kit.expect_array(
            vb_next - va_next,
            slip + e * float((va - vb) @ n) * n,
            abs=1e-9 * (1 + _speeds(args)),
            source=bundles.ROUNDING,
            quantity="vb - va",
            units="m/s",
            **finding,
        )


@np.errstate(all="ignore")
def expect_energy(submission, calls):
    """The energy that is lost is (1 - e²)/2 times the reduced mass times the square of the approach."""
    task = bundles.RESOLVE
    parts, diagnose = _impacts(submission, task, calls)
    for args, found in zip(calls, parts, strict=True):
        ma, mb, va, vb, n, e = args
        before = probes.energy(ma, mb, va, vb)
        lost = 0.5 * (1 - e * e) * float((va - vb) @ n) ** 2 / (1 / ma + 1 / mb)
        finding = _finding(
            task,
            args,
            "The kinetic energy after an impact is not what the restitution says.",
            "Of the energy of approach along the normal a share of e squared is left; the rest is "
            "not touched.",
            diagnose,
        )
        kit.expect_close(
            probes.energy(ma, mb, *found),
            before - lost,
            abs=1e-9 * (before + 1),
            source=bundles.ROUNDING,
            quantity="kinetic energy",
            units="J",
            **finding,
        )
        _expect_response(args, found, finding)


@np.errstate(all="ignore")
def expect_braking(submission, calls):
    """Friction: momentum kept, energy never more, the slip smaller and in the same direction."""
    task = bundles.FRICTION
    parts, diagnose = _impacts(submission, task, calls)
    for args, found in zip(calls, parts, strict=True):
        ma, mb, va, vb, n = args[:5]
        help_ = (
            "Along the normal acts J, as in `resolve`. Friction acts across it, on b against the slip and on "
            "a the other way, and stops the slip at most."
        )
        finding, adds, brakes = (
            _finding(task, args, message, help_, diagnose)
            for message in (
                "The total momentum changes, although no outside force acts.",
                "An impact with friction adds energy.",
                "Friction does not brake the slip as it should.",
            )
        )
        _expect_momentum(args, found, finding)
        before = probes.energy(ma, mb, va, vb)
        kit.expect_bounded(
            probes.energy(ma, mb, *found),
            high=before * (1 + 1e-9),
            source=bundles.ROUNDING,
            quantity="kinetic energy",
            units="J",
            **adds,
        )
        slips = [(w - u) - ((w - u) @ n) * n for u, w in ((va, vb), found)]
        size = float(np.sqrt(slips[0] @ slips[0]))
        left = float(slips[1] @ slips[0]) / size
        # Every scene has friction enough to take at least a third of the slip.
        kit.expect_bounded(
            left,
            low=-1e-9 * (1 + _speeds(args)),
            high=0.75 * size,
            source="the scenes: friction takes at least 0.3 of each slip, and never more than all",
            quantity="slip afterwards",
            units="m/s",
            **brakes,
        )


# -- symmetries -----------------------------------------------------------------------------------------


@np.errstate(all="ignore")
def expect_line_symmetries(submission, rng):
    """One impact on a line five times: as it is, from trains, mirrored, exchanged."""
    task = bundles.IMPULSE
    ma, mb, va, vb, e = draws.line(rng)
    train = float(rng.uniform(20.0, 40.0))
    calls = [
        (ma, mb, va, vb, e),
        (ma, mb, va + train, vb + train, e),
        (ma, mb, va - train, vb - train, e),
        # In the mirror the right body is the left one.
        (mb, ma, -vb, -va, e),
        (mb, ma, va, vb, e),
    ]
    train_says = "Seen from a moving train, the impulse is different."
    names = (
        ("The impulse of an impact on a line is wrong.", None),
        (train_says, "DEPENDS_ON_THE_FRAME"),
        (train_says, "DEPENDS_ON_THE_FRAME"),
        ("Seen in a mirror, the impulse is different.", None),
        ("With a and b exchanged, the impulse is different.", None),
    )
    values, parts = bundles.answers(submission, task, calls)
    truth = bundles.right(task, calls)
    base = truth[0]
    for args, found, (message, code) in zip(calls, parts, names, strict=True):
        kit.expect_close(
            found[0],
            base,
            rel=1e-9,
            source=bundles.ROUNDING,
            quantity="impulse",
            units="N s",
            input=bundles.shown(task, args),
            message=message,
            help="The right impulse depends on the difference of the velocities alone, and on both masses in "
            "the same way.",
            diagnose=lambda code=code: (
                probes.of_calls(task, calls, values, truth) or (code and bundles.named(code))
            ),
        )


@np.errstate(all="ignore")
def expect_symmetries(submission, task, rng):
    """One impact five times: as it is, from a train, turned, mirrored, exchanged."""
    args = draws.friction(rng, 3, 0.6) if task == bundles.FRICTION else draws.impact(rng, 3)
    ma, mb, va, vb, n, *rest = args
    train = rng.uniform(10.0, 20.0, 3)
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    mirror = turn @ np.diag([1.0, 1.0, -1.0])
    calls = [
        args,
        (ma, mb, va + train, vb + train, n, *rest),
        (ma, mb, turn @ va, turn @ vb, turn @ n, *rest),
        (ma, mb, mirror @ va, mirror @ vb, mirror @ n, *rest),
        (mb, ma, vb, va, -n, *rest),
    ]
    a, b = bundles.right(task, [args])[0]
    wanted = [(a, b), (a + train, b + train), (turn @ a, turn @ b), (mirror @ a, mirror @ b), (b, a)]
    words = (
        ("The velocities after an impact are wrong.", None),
        ("Seen from a moving train, the impact is different.", "DEPENDS_ON_THE_FRAME"),
        ("Turned as a whole, the impact is different.", "DEPENDS_ON_DIRECTION"),
        ("Seen in a mirror, the impact is different.", "DEPENDS_ON_DIRECTION"),
        ("With a and b exchanged, the impact is different.", None),
    )
    parts, diagnose = _impacts(submission, task, calls)
    for given, found, true, (message, code) in zip(calls, parts, wanted, words, strict=True):

        def look(code=code):
            return diagnose() or (code and bundles.named(code))

        finding = _finding(
            task,
            given,
            message,
            "Along n each velocity changes by J over its mass, with J from s = (va - vb) . n alone. "
            "Friction, if there is any, acts across n, and nothing else does.",
            look,
        )
        bundles.expect_velocities(found, true, finding, _speeds(given))


@np.errstate(all="ignore")
def expect_wall(submission, task, rng):
    """An infinite mass on either side, moving: anyhow, and more slowly than the body that runs into it.

    With friction the body slides on where the wall is slow, and sticks to it otherwise.
    """
    calls = []
    for side, slowly in ((0, True), (1, True), (0, False), (1, False)):
        args = (
            draws.friction(rng, 3, rng.uniform(0.4, 0.8) if slowly else rng.uniform(1.3, 3.0))
            if task == bundles.FRICTION
            else draws.impact(rng, 3)
        )
        calls.append(draws.wall(draws.chased(rng, args, side) if slowly else args, side))
    bundles.expect_formula(
        submission,
        task,
        calls,
        "With a body of infinite mass (a wall) the velocities are wrong.",
        bundles.WALLS[task],
    )


@np.errstate(all="ignore")
def expect_clean(submission, task, rng):
    """Arguments are left alone."""
    args = draws.friction(rng, 3, 0.6) if task == bundles.FRICTION else draws.impact(rng, 3)
    inspected = submission.call_inspect(task, *args)
    given = {"input": bundles.shown(task, args)}
    found = kit.as_pair(inspected.value, 3, ("va_next", "vb_next"))
    truth = bundles.right(task, [args])
    diagnose = lambda: probes.of_calls(task, [args], [tuple(found)], truth)  # noqa: E731 - one look
    finding = given | {
        "message": "The velocities after an impact are wrong.",
        "help": "Take one such impact by hand, as the README's example does, and compare number by number.",
        "diagnose": diagnose,
    }
    bundles.expect_velocities(found, truth[0], finding, _speeds(args))
    touched = bundles.named("MUTATES_INPUT")
    # Handing back the very arrays is right where nothing changes, and everything changes here.
    names = ["", "", "va", "vb", "normal", *[""] * (len(args) - 5)]
    kit.expect_untouched(args, inspected, names=names, mutated=touched, shared=touched, **given)
