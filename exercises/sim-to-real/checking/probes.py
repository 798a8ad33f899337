"""Finding out which mistake a failed check looks like, for the exercise ``sim-to-real``.

A command is recognised by its shape and its spectrum, an estimate by how its values relate to the truth over
several carts, gains by what they do when the estimate or the box is changed.
"""

from __future__ import annotations

import functools
import math

import numpy as np

from course.scoring import kit

bench = kit.companion("sim-to-real", "bench")
cart = kit.companion("sim-to-real", "cart")
named = kit.words("sim-to-real")
NAMES = cart.NAMES
ALL = (*NAMES, "lag")


# -- reading what came back -----------------------------------------------------------------------------


def patient(call, slow):
    """``call()``; where time runs out, a finding with the code ``slow``, which says how it is made quick."""
    try:
        return call()
    except kit.StudentFailure as failure:
        if failure.kind != "timeout":
            raise
        kit.fail("The call takes too long.", diagnose=named(slow))


def command_of(value, seconds, u_max):
    """A command as an array of the right length, finite and within the bench's force.

    Raises:
        CheckFailed: it is none.
    """
    u = kit.as_vector(value, None, "the command")
    given = {"budget_s": seconds, "u_max": u_max}
    kit.expect_length(
        u,
        round(100 * seconds),
        message="The excitation does not have the required length.",
        diagnose=named("WRONG_LENGTH"),
        input=given,
    )
    kit.expect_true(
        bool(np.all(np.isfinite(u))),
        "The excitation contains values that are not finite numbers.",
        diagnose=named("NOT_FINITE"),
        input=given,
    )
    kit.expect_bounded(
        float(np.abs(u).max()),
        high=u_max * (1 + 1e-9),
        source="the bench's force, with room for rounding",
        quantity="largest force",
        units="N",
        message="The excitation commands more force than u_max.",
        diagnose=named("EXCITATION_SATURATES"),
        input=given,
    )
    return u


def estimate_of(value):
    """An estimate as {name: (value, low, high)} of finite numbers.

    Raises:
        CheckFailed: it is none.
    """
    record = kit.as_record(value, ALL)
    found = {k: _entry(k, record[k]) for k in ALL}
    if not all(math.isfinite(x) for entry in found.values() for x in entry):
        kit.fail("An estimate is not a finite number.", diagnose=named("NOT_FINITE"), actual=found)
    return found


def _entry(name, value):
    """One entry as (value, low, high)."""
    listed = isinstance(value, list | tuple) or (isinstance(value, np.ndarray) and value.ndim > 0)
    if not listed or len(value) != 3:
        kit.fail(
            f"The entry `{name}` is not [value, low, high].",
            help="Each entry has three numbers: the estimate, and the two ends of its 95 % interval.",
            diagnose="WRONG_SHAPE",
            expected="[value, low, high]",
            actual=value,
        )
    return tuple(kit.as_vector(value, 3, f"the entry {name}").tolist())


def gains_of(value):
    """Gains as (kp, kd), finite and not absurd.

    Raises:
        CheckFailed: they are not.
    """
    record = kit.as_record(value, ("kp", "kd"))
    kp, kd = (kit.as_number(record[k], k) for k in ("kp", "kd"))
    if not (math.isfinite(kp) and math.isfinite(kd)):
        kit.fail("A gain is not a finite number.", diagnose=named("NOT_FINITE"))
    if kp < 0 or kd < 0:
        kit.fail("A gain has the wrong sign.", diagnose=named("GAINS_NEGATIVE"), actual=[kp, kd])
    if max(kp, kd) >= 1e6:  # the rollout itself would overflow
        kit.fail(
            "A gain is a million or more.",
            help="Search over kp from 2 to 40, and kd/kp from 0.2 to 0.8.",
        )
    return kp, kd


# -- design_excitation ----------------------------------------------------------------------------------


def of_command(u, carts=(), u_max=cart.U_BENCH, enough=lambda u: False):
    """Why a command does not show everything. u: shape (N,), N.

    carts: those of which it does not
    enough: whether another command, (N,), would do
    """
    u = np.asarray(u, dtype=float)
    peak = float(np.abs(u).max())
    power = np.abs(np.fft.rfft(u - u.mean())) ** 2
    frequency = np.fft.rfftfreq(len(u), cart.H)
    looks = (
        ("EXCITATION_ZERO", lambda: peak == 0.0),
        ("EXCITATION_ENDS", lambda: np.flatnonzero(u)[-1] < 0.6 * len(u) - 1),
        ("EXCITATION_RESTS", lambda: np.mean(u == 0.0) > 0.6),
        ("EXCITATION_CONSTANT", lambda: np.count_nonzero(np.diff(u)) <= 2),
        ("EXCITATION_RESTS", lambda: np.mean(u == 0.0) > 0.4),
        ("EXCITATION_TOO_WEAK", lambda: peak < u_max / 3),
        ("EXCITATION_NOT_FULL", lambda: peak < 0.9 * u_max and enough(u * u_max / peak)),
        ("EXCITATION_TOO_SLOW", lambda: power[frequency < 0.3].sum() > 0.7 * power.sum()),
        ("EXCITATION_TOO_FAST", lambda: power[frequency > 4.0].sum() > 0.7 * power.sum()),
        ("EXCITATION_STANDS", lambda: len(carts) and np.mean(cart.speeds(u, carts) == 0, axis=0).max() > 0.6),
        ("EXCITATION_ONE_RATE", lambda: _one_rate(u)),
        (
            "EXCITATION_MOSTLY_WEAK",
            lambda: np.mean(np.abs(u) < u_max / 2) > 0.4 and enough(np.where(u < 0, -u_max, u_max)),
        ),
        ("EXCITATION_BLIND", lambda: True),
    )
    return next(named(code) for code, seen in looks if seen())


def _one_rate(u):
    """Whether the command crosses its middle after the same time each time, to two samples, to its end."""
    above = u > (u.max() + u.min()) / 2
    holds = np.diff(np.flatnonzero(np.diff(above)), prepend=-1, append=len(u) - 1)
    return len(holds) > 7 and np.ptp(holds[1:-1]) <= 2 and max(holds) <= holds[1] + 2


# -- identify -------------------------------------------------------------------------------------------


def of_values(estimates, truths, recordings=(), single=None):
    """What the values of several estimates look like beside the true carts.

    recordings: (t, u, y) of each, where there is one
    single: estimates and carts of the recordings, where ``estimates`` are means over some of them
    """
    got = {k: np.array([estimate[k][0] for estimate in estimates]) for k in ALL}
    true = {k: np.array([_known(truth)[k] for truth in truths]) for k in ALL}
    with np.errstate(all="ignore"):
        found = next((code for code, looks in _LIKENESSES if looks(got, true)), None)
    if found != "ESTIMATE_HARD_CODED":
        found = _fitted_otherwise(*(single or (estimates, truths)), recordings) or found
    # The low ends of tau and latency do not add up to that of lag, whose interval is narrower than both.
    if found == "LAG_NOT_SUM" and all(a < b < c for each in estimates for a, b, c in each.values()):
        return named("INTERVAL_REVERSED")
    # A fit to a speed that was differentiated may leave a time at the edge of its range.
    if found in (None, "PARAMETER_FIXED") and _differentiated(got, true, recordings):
        return named("NOISE_DIFFERENTIATED")
    return named(found) if found else _beside_the_fit(*(single or (estimates, truths)), recordings)


#: The parameters of a fit whose times are known.
_OF_FIT = ("m", "b", "Fc")


def _with_times(estimates, recordings):
    """Pairs of a recording and an estimate of it whose times are ones that a fit can be made with."""
    return [
        (recording, estimate)
        for recording, estimate in zip(recordings, estimates, strict=False)
        if 0.005 < estimate["tau"][0] < 1.0 and 0.0 <= estimate["latency"][0] < 1.0
    ]


def _fitted_otherwise(estimates, truths, recordings):
    """Which wrong fit gives these m, b and Fc with the times that came back, as a code, or None.

    Of the same recordings and times a fit gives the same numbers: they have to be far nearer to its own than
    to the carts' and to those of the README's fit, each in every parameter, over several recordings.
    """
    pairs = _with_times(estimates, recordings)
    if len(pairs) < 2 or len(pairs) < len(estimates):
        return None
    unit = np.array([[cart.SCORED[k] * truth[k] for k in _OF_FIT] for truth in truths])
    got = np.array([[each[k][0] for k in _OF_FIT] for each in estimates])

    def off(values):
        return math.sqrt(np.mean(np.square((got - values) / unit)))

    with np.errstate(all="ignore"):
        made = [bench.fits(u, y, each["tau"][0], each["latency"][0]) for (_, u, y), each in pairs]
    away = {name: off([each[name] for each in made]) for name in made[0]}
    own = min(off([[truth[k] for k in _OF_FIT] for truth in truths]), away.pop(""))
    code = min(away, key=away.get).split()[0]
    least, other = (
        min(off for name, off in away.items() if (name.split()[0] == code) is same) for same in (True, False)
    )
    # What is nearer to the right values has to be that fit's own numbers.
    most = 0.15 if own > 0.15 else 0.005
    return code if own > 0.03 and least < most * min(own, other) else None


def _beside_the_fit(estimates, truths, recordings):
    """What values say beside those of the README's fit with the times that came back.

    They are its own, and with the carts' times it mostly leaves less; or they are others, and its own right.
    """
    pairs = _with_times(estimates, recordings)
    if not pairs or len(pairs) < len(estimates):
        return None
    ratios, others, known = [], [], []
    for ((_, u, y), each), truth in zip(pairs, truths, strict=True):
        values, left = bench.fit(u, y, each["tau"][0], each["latency"][0])
        others.append(np.abs([each[k][0] for k in _OF_FIT] / values - 1))
        known.append(np.abs(values / [truth[k] for k in _OF_FIT] - 1))
        ratios.append(left / bench.fit(u, y, truth["tau"], truth["latency"])[1])
    if np.max(others) <= 0.01:
        return named("TIMES_NOT_BEST") if np.median(ratios) > 1.05 else None
    limits = np.array([cart.SCORED[k] for k in _OF_FIT])
    wrong = np.any(np.median(others, axis=0) > 0.5 * limits)
    return named("OTHER_FIT") if wrong and np.all(known < limits) else None


def of_command_kept(submission, recordings):
    """Whether the first recording gets the same estimate, to the last digit, with its command run backwards.

    Impulses kept by tau from one call to the next do that. Asked first with the right command, so that what
    is kept for the times near it is there.
    """
    if not len(recordings):
        return None
    t, u, y = recordings[0]
    asked = [(t, u, y), (t, np.array(u[::-1]), y)]
    found = kit.attempt(lambda: [estimate_of(each) for each in submission.call_each("identify", asked)])
    return named("COMMAND_KEPT") if found and found[0] == found[1] else None


def _differentiated(got, true, recordings):
    """Whether the masses are too small, and those that come of differentiating the speed, by either way.

    With the right times, or with those that came back.
    """
    if not recordings or _right(got, true, "m") or not _share(got, true, "m") < 1:
        return False
    in_range = np.all((got["tau"] > 0.005) & (got["latency"] >= 0))
    for times in (true, got) if in_range else (true,):
        each = [
            bench.differentiated(u, y, {"tau": tau, "latency": late})
            for (_, u, y), tau, late in zip(recordings, times["tau"], times["latency"], strict=False)
        ]
        if any(_alike(got["m"], np.array(masses), 0.04, 0.1) for masses in zip(*each, strict=True)):
            return True
    return False


def of_misses(estimates, truths, recordings=(), otherwise="INTERVAL_OVERCONFIDENT", name=None):
    """Why intervals miss the truth, or are too wide: values that are off by themselves come first.

    name: the parameter that the finding is about, if it is about one
    """
    found = of_values(estimates, truths, recordings)
    if found:
        return found
    if name == "lag" and otherwise == "INTERVAL_USELESS" and all(ends_added(each) for each in estimates):
        return named("LAG_ENDS_ADDED")
    code = _of_widths(estimates, recordings)
    if code:
        return named(code)
    for estimate, truth in zip(estimates, truths, strict=True):
        known = _known(truth)
        if any(abs(estimate[k][0] / known[k] - 1) > limit for k, limit in cart.SCORED.items()):
            return named("VALUES_OFF")
    return named(otherwise)


def of_points(estimates, truths):
    """Why intervals have no width: a parameter may be the same for all carts, in every refit too."""
    found = of_values(estimates, truths)
    fixed = found is not None and found.code in ("ESTIMATE_HARD_CODED", "TIME_FROM_SHEET", "PARAMETER_FIXED")
    return found if fixed else named("INTERVAL_WITHOUT_WIDTH")


def ends_added(estimate):
    """Whether the ends of the interval of lag are the sums of those of tau and latency, and two."""
    tau, late, lag = (estimate[k] for k in ("tau", "latency", "lag"))
    return lag[2] - lag[1] > 1e-9 * abs(lag[0]) and all(
        math.isclose(tau[i] + late[i], lag[i], rel_tol=1e-9) for i in (1, 2)
    )


def squares_added(estimate):
    """Whether the width of lag is that of a sum of independent errors, of tau and of latency."""
    tau, late, lag = (estimate[k][2] - estimate[k][1] for k in ("tau", "latency", "lag"))
    return lag > 0 and math.isclose(math.hypot(tau, late), lag, rel_tol=1e-9)


def over_errors(estimates, recordings):
    """Half-widths over the standard errors of the README's jackknife, (estimates, 6), or None.

    Only where the values are those of its fit can they be held against it: another method has other errors.
    Values of one fit differ by rounding; those of right methods that fit otherwise by 0.3 errors and more.
    """
    pairs = _with_times(estimates, recordings)
    if len(pairs) < 2 or len(pairs) < len(estimates):
        return None
    ratios, away = [], []
    for (_, u, y), each in pairs:
        times = each["tau"][0], each["latency"][0]
        error = bench.errors(u, y, *times)[""]
        ratios.append([(each[k][2] - each[k][1]) / 2 / one for k, one in zip(ALL, error, strict=True)])
        away.append(np.abs([each[k][0] for k in _OF_FIT] - bench.fit(u, y, *times)[0]) / error[:3])
    return np.array(ratios) if np.max(np.median(away, axis=0)) < 0.1 else None


def of_narrow(estimates, recordings, ratios):
    """Why intervals are too narrow for the fit that their values come of. ratios: of ``over_errors``."""
    code = _of_widths(estimates, recordings)
    if code:
        return named(code)
    inverse = np.array([ratio[0] * each["m"][0] ** 2 for ratio, each in zip(ratios, estimates, strict=True)])
    if np.max(np.abs(inverse / 2.1 - 1)) < 0.1:
        return named("INTERVAL_OF_INVERSE")
    for (_, u, y), each, ratio in zip(recordings, estimates, ratios, strict=True):
        made = bench.errors(u, y, each["tau"][0], each["latency"][0])
        if np.max(np.abs(ratio[:3] * made[""][:3] / made["held"][:3] / 2.1 - 1)) > 0.15:
            return named("INTERVAL_NARROW")
    return named("TIMES_HELD")


#: Half-widths over standard errors by the README's jackknife, for n blocks: which mistake leaves which.
_LEAVES = (
    ("INTERVAL_PLAIN_SPREAD", lambda n: 2.1 / (n - 1)),  # np.std over the root of n
    ("INTERVAL_PLAIN_SPREAD", lambda n: 2.1 / math.sqrt(n - 1)),  # np.std
    ("INTERVAL_ONE_ERROR", lambda n: 1.0),
)


def _of_widths(estimates, recordings):
    """What half-widths over the standard errors of the same recordings say of how they are made, or None."""
    pairs = _with_times(estimates, recordings)
    if len(pairs) < 2 or len(pairs) < len(estimates):
        return None
    with np.errstate(all="ignore"):
        made = [bench.errors(u, y, each["tau"][0], each["latency"][0]) for (_, u, y), each in pairs]
    half = np.array([[(each[k][2] - each[k][1]) / 2 for k in ALL] for each in estimates])
    own, kept_out = (np.array([each[name] for each in made]) for name in ("", "kept out"))
    scored = [ALL.index(k) for k in cart.SCORED]

    def times(other, most):
        """By how much these are wider than others, where that is alike for all of the scored parameters."""
        ratio = np.maximum(half, 1e-300) / other
        typical = np.median(ratio[:, scored], axis=0)
        middle = float(np.exp(np.mean(np.log(typical))))
        return middle if np.all(np.abs(np.log(typical / middle)) < most) else math.nan

    n = len(recordings[0][1]) // 100
    for code, factor in _LEAVES:
        if abs(math.log(times(own, 0.12) / factor(n))) < 0.08:
            return code
    if abs(math.log(times(own**2, 0.25) / 2.05)) < 0.15:
        return "INTERVAL_ROOT_MISSING"
    if abs(math.log(times(kept_out, 0.2) / 2.1)) < 0.12 and np.median(half[:, 0] / own[:, 0]) > 4.2:
        return "BLOCKS_KEPT_OUT"
    formula = (
        half[:, :1] / [[each["m"][0]] for each in estimates] / np.array([each["formula"] for each in made])
    )
    alike = np.ptp(formula, axis=0) < 0.06 * formula.mean(axis=0)
    return "INTERVAL_BY_FORMULA" if np.any(alike & (np.abs(formula.mean(axis=0) - 2) < 0.15)) else None


def _known(truth):
    return {**truth, "lag": truth["tau"] + truth["latency"]}


def _alike(a, b, rel, most=math.inf):
    """Whether half of them are alike to within ``rel``, and all to within ``most``."""
    off = np.abs(a / b - 1)
    return bool(np.median(off) < rel and np.max(off) <= most)


def _share(got, true, name):
    return float(np.median(got[name] / true[name]))


#: What to look for, the most telling first: code and whether (values, truths) look like it.
_LIKENESSES = (
    (
        "ESTIMATE_HARD_CODED",
        lambda got, true: len(got["m"]) > 1 and all(np.ptp(got[k]) <= 1e-9 for k in ("m", "b", "Fc", "lag")),
    ),
    (
        "ESTIMATE_HARD_CODED",
        lambda got, true: all(_alike(got[k], cart.SHEET[k], 1e-6) for k in ("m", "b", "Fc")),
    ),
    (
        "MASS_INVERTED",
        lambda got, true: _alike(got["m"] * true["m"], 1.0, 0.05, 0.1) and not _right(got, true, "m"),
    ),
    (
        "UNITS_NOT_SECONDS",
        lambda got, true: any(
            _alike(got[k], times * true[k], 0.2) for k in ("lag", "tau", "latency") for times in (1000, 100)
        ),
    ),
    (
        "LAG_NOT_SUM",
        lambda got, true: not _alike(got["lag"], got["tau"] + got["latency"], 0.02),
    ),
    (
        "LATENCY_IGNORED",
        lambda got, true: np.median(np.abs(got["latency"])) < 0.012 and np.median(got["m"]) > 0,
    ),
    ("LAG_IGNORED", lambda got, true: np.median(np.abs(got["tau"])) < 0.012 and np.median(got["m"]) > 0),
    (
        "TIME_FROM_SHEET",
        lambda got, true: len(got["tau"]) > 1 and any(_sheet(got, true, k) for k in ("tau", "latency")),
    ),
    (
        "PARAMETER_FIXED",
        lambda got, true: len(got["m"]) > 1 and any(_fixed(got, true, k) for k in NAMES),
    ),
    (
        "ESTIMATE_NEGATIVE",
        lambda got, true: (
            np.median(got["m"]) < 0 or min(np.median(got[k]) for k in ("tau", "latency")) < -0.01
        ),
    ),
    (
        "FORCE_SCALED",
        lambda got, true: (
            _right(got, true, "lag")
            and not _alike(got["m"], true["m"], 0.1)
            and all(_alike(got[k] / true[k], got["m"] / true["m"], 0.08) for k in ("b", "Fc"))
        ),
    ),
    ("LAG_TOO_LONG", lambda got, true: _shifted(got["lag"] - true["lag"], got, true)),
    ("LAG_TOO_SHORT", lambda got, true: _shifted(true["lag"] - got["lag"], got, true)),
    ("LOCAL_MINIMUM", lambda got, true: np.median(np.abs(got["lag"] / true["lag"] - 1)) > 0.25),
    ("FRICTION_SIGN", lambda got, true: _share(got, true, "b") < -0.5 or _share(got, true, "Fc") < -0.5),
    (
        "COEFFICIENTS_NOT_PARAMETERS",
        lambda got, true: (
            _right(got, true, "m")
            and any(_alike(got[k] * true["m"], true[k], 0.05, 0.12) for k in ("b", "Fc"))
            and all(
                _right(got, true, k) or _alike(got[k] * true["m"], true[k], 0.05, 0.12) for k in ("b", "Fc")
            )
        ),
    ),
    ("COULOMB_AS_VISCOUS", lambda got, true: _share(got, true, "Fc") < 0.3 and _share(got, true, "b") > 1.05),
    ("VISCOUS_AS_COULOMB", lambda got, true: _share(got, true, "b") < 0.3 and _share(got, true, "Fc") > 1.05),
    (
        "FRICTIONS_SWAPPED",
        lambda got, true: _alike(got["b"], true["Fc"], 0.1, 0.2) and _alike(got["Fc"], true["b"], 0.1, 0.2),
    ),
    ("VISCOUS_MISSING", lambda got, true: abs(_share(got, true, "b")) < 0.3),
    ("COULOMB_MISSING", lambda got, true: abs(_share(got, true, "Fc")) < 0.3),
)


def _shifted(late, got, true):
    """Whether these times are alike, and about a sample or more, though the lags differ; m is right."""
    middle = float(np.median(late))
    alike = np.max(np.abs(late - middle)) < 0.0015 + 0.1 * abs(middle)
    return bool(middle > 0.008 and alike and np.ptp(true["lag"]) > 0.01 and _right(got, true, "m"))


def exchanged(estimates, truths):
    """Whether tau comes out near the latency, and the latency near tau, of each cart in which they differ."""
    pairs = zip(estimates, truths, strict=True)
    apart = [(each, cart) for each, cart in pairs if abs(cart["latency"] / cart["tau"] - 1) > 0.2]
    return bool(apart) and all(
        abs(each["tau"][0] / cart["latency"] - 1) < 0.08 and abs(each["latency"][0] / cart["tau"] - 1) < 0.08
        for each, cart in apart
    )


def _sheet(got, true, name):
    """Whether a time is the data sheet's each time, to many digits, though the carts have others."""
    return bool(np.all(np.abs(got[name] / cart.SHEET[name] - 1) < 1e-6)) and bool(np.ptp(true[name]) > 0)


def _fixed(got, true, name):
    """Whether a parameter, not a missing one, is the same to many digits though the carts differ in it."""
    steady = np.ptp(got[name]) <= 1e-9 * np.max(np.abs(got[name]))
    return bool(steady and np.ptp(true[name]) > 0 and abs(_share(got, true, name)) > 0.3)


def _right(got, true, name):
    return _alike(got[name], true[name], cart.SCORED[name])


# -- tune -----------------------------------------------------------------------------------------------


def of_gains(submission, estimate, box, gains, success):
    """Why gains do badly: what they are best for, and what becomes of them when the question changes.

    Gains that stay as they are prove nothing while the search may have ended at its edge, so that is looked
    at first; and each question is changed both ways, or so far that other gains must come out.

    Args:
        estimate, box: what they were asked for.
        success: function of (kp, kd), on carts of this estimate.
    """
    kp, kd = gains
    heavy, light = (_with(estimate, ("m", "b"), factor) for factor in (2.5, 0.4))
    late = _with(estimate, ("latency", "lag"), 2.2)
    loaded = {k: [_LOAD.get(k, 1.0) * end for end in ends] for k, ends in box.items()}
    questions = [(heavy, box), (light, box), (late, box), (estimate, loaded)]
    try:
        other = [gains_of(each) for each in submission.call_each("tune", questions)]
    except kit.StudentFailure as failure:
        return named("TUNE_RAISES") if failure.kind == "error" else None
    except kit.CheckFailed:
        return None
    same = [math.isclose(kp, p, rel_tol=1e-3) and math.isclose(kd, d, rel_tol=1e-3) for p, d in other]
    # One kp for most questions, with others better: the grid ends there, or the search never leaves it.
    alike = sum(math.isclose(kp, p, rel_tol=1e-6) for p, _ in other)
    stays = alike >= 3
    prompt, sooner = {**estimate, "latency": [0.001] * 3}, _with(estimate, ("latency", "lag"), 0.4)
    very_late = _with(estimate, ("latency", "lag"), 4.5)
    # One change may leave the best gains of a coarse search where they are; these lie the other way.
    unloaded = {k: [end / _LOAD.get(k, 1.0) for end in ends] for k, ends in box.items()}
    boxes = (estimate, unloaded), (estimate, {k: [1.0, 1.0] for k in box})
    ends = {k: [value, 0.5 * value, 2.0 * value] for k, (value, *_) in estimate.items()}, box

    def unmoved(*asked):
        found = kit.attempt(lambda: [gains_of(each) for each in submission.call_each("tune", list(asked))])
        return found and all(
            math.isclose(kp, p, rel_tol=1e-3) and math.isclose(kd, d, rel_tol=1e-3) for p, d in found
        )

    def swapped():
        """Whether the right gains come in the other order, for this question and for two others."""
        does = success(kd, kp) > max(0.9, 1.2 * success(kp, kd))
        return does and all(
            _is_best(d, p, *asked) for (p, d), asked in zip(other[:2], questions, strict=False)
        )

    @functools.cache
    def failing():
        return _of_failing(gains, estimate, box)

    @functools.cache
    def ended_early():
        return success(*_better(gains, success)) > 1.03 * success(kp, kd)

    def larger_is_better():
        pairs = [(a * kp, b * kd) for a in (1.25, 1.45, 1.6, 2.2) for b in (0.7, 1.0, 1.3, 1.6)]
        return max(success(*pair) for pair in pairs) > 1.03 * success(kp, kd)

    def ended_far_off():
        return success(*_best_of_grid(estimate, box)) > 1.03 * success(kp, kd)

    def box_alone():
        """Whether, for a box around the data sheet's values, the gains suit carts with these values."""
        asked = [(each, _UNITS_BOX) for each in (estimate, heavy)]
        found = kit.attempt(lambda: [gains_of(each) for each in submission.call_each("tune", asked)])
        return found is not None and found[0] == found[1] and _lateness_of(found[0], _UNITS_BOX) < 1.05

    @functools.cache
    def summed():
        found = _of_sums([(estimate, box), *questions], [gains, *other])
        if found != "TIED":
            return found
        # With all gains the slowest cart counts as 3 s: on a narrow box it settles.
        narrow = {k: [(low / high) ** 0.2, (high / low) ** 0.2] for k, (low, high) in box.items()}
        asked = [(each, narrow) for each in (estimate, heavy)]
        answers = kit.attempt(lambda: [gains_of(each) for each in submission.call_each("tune", asked)])
        return answers and _of_sums([(estimate, box), *asked], [gains, *answers])

    looks = (
        ("GAINS_SWAPPED", swapped),
        (
            "KD_IS_RATIO",
            lambda: _are_ratios([gains, *other]) and _would_do(kp, kp * kd, gains, estimate, box, success),
        ),
        ("ROLLOUT_GIVEN_RATIO", lambda: summed() == "ROLLOUT_GIVEN_RATIO"),
        # The mark is 1 m away: with less than friction the cart never moves, damped or not.
        ("NO_DAMPING", lambda: kd < 0.05 * kp and kp > estimate["Fc"][0]),
        ("BOX_WITHOUT_ESTIMATE", lambda: all(same[:3]) and not same[3] and box_alone()),
        (
            "ESTIMATE_IGNORED",
            lambda: (
                all(same[:3])
                and not same[3]
                and failing() != "NO_CART_SETTLES"
                and _never_changes(submission, estimate, box, gains)
            ),
        ),
        ("GAINS_HARD_CODED", lambda: all(same) and _never_changes(submission, estimate, box, gains)),
        ("WORST_CART", lambda: summed() == "WORST_CART"),
        ("SLOW_TAIL", lambda: summed() == "SLOW_TAIL"),
        (
            "KP_STAYS",
            lambda: stays and not all(same) and larger_is_better() and failing() != "NO_CART_SETTLES",
        ),
        ("SEARCH_ENDED_EARLY", lambda: all(same) or (stays and ended_early())),
        ("ENDS_READ", lambda: unmoved(ends) is False and unmoved((estimate, box))),
        # Where nothing settles, gains are as good as any others, and what they depend on shows nothing.
        ("NO_CART_SETTLES", lambda: failing() == "NO_CART_SETTLES"),
        (
            "GAINS_BY_FORMULA",
            lambda: same[2] and same[3] and not (same[0] or same[1]) and unmoved((sooner, box), *boxes),
        ),
        (
            "DELAY_IGNORED",
            # A quarter of a second more changes the best gains so much that no grid is too coarse to show it.
            lambda: (
                same[2] and _is_best(kp, kd, prompt, box, 1.5) and unmoved((sooner, box), (very_late, box))
            ),
        ),
        # Gains that stay for heavy carts too are at the search's edge, which the box cannot move.
        ("RANDOMIZATION_IGNORED", lambda: same[3] and not same[0] and unmoved(*boxes)),
        ("KP_STAYS", lambda: alike > 1 and not all(same) and larger_is_better()),
        ("KD_FOLLOWS_KP", lambda: _follows([gains, *other], [estimate, *(asked for asked, _ in questions)])),
    )
    rest = (
        ("MEDIAN_CART", lambda: summed() == "MEDIAN_CART"),
        ("FAILURES_LEFT_OUT", lambda: failing() is not None),
    )
    code = next((code for code, seen in looks if seen()), None) or _unread(submission, estimate, box, gains)
    code = code or _best_for_others([(estimate, box), *questions], [gains, *other])
    code = code or next((code for code, seen in rest if seen()), None)
    return named(code or "SEARCH_ENDED_EARLY") if code or ended_early() or ended_far_off() else None


#: A box in the parameters' own units.
_UNITS_BOX = {k: [0.9 * value, 1.1 * value] for k, value in cart.SHEET.items()}


def _lateness_of(gains, box):
    """The mean settling time over the best of a grid, on carts drawn from the box itself."""
    carts = _drawn({k: [1.0] for k in NAMES}, box, 50)[1]
    pairs = (np.append(all_, one) for all_, one in zip(_grid(), gains, strict=True))
    mean = cart.rollout(*pairs, carts, np.random.default_rng(32)).mean(axis=0)
    return mean[-1] / mean.min()


def _of_sums(questions, answers):  # noqa: PLR0911 - one return per mistake
    """What gains are the best for in all questions, where it is not the mean; a code or None.

    ROLLOUT_GIVEN_RATIO: with kd/kp in place of kd the mean is least. WORST_CART: the slowest time is least;
    where that is 3 s with all gains, the same come each time; TIED: it always is. SLOW_TAIL: the mean and two
    deviations are, as a high percentile is. MEDIAN_CART: the median is.
    """
    kp, kd = _grid()
    mean, middle, most, tail, ratio = [], [], [], [], []
    for (estimate, box), (p, d) in zip(questions, answers, strict=True):
        around = np.array(_AROUND[1:]).T
        pairs = np.concatenate([kp, p * around[0], [p]]), np.concatenate([kd, d * around[1], [d]])
        times = _settling(pairs, estimate, box)
        for found, of_all in (
            (mean, times.mean(0)),
            (middle, np.median(times, 0)),
            (most, times.max(0)),
            (tail, times.mean(0) + 2 * times.std(0)),
        ):
            found.append((of_all[-1], of_all.min()))
        if p > 0 and 0.1 < d / p < 1.0:
            other = np.append(kp, p), np.append(kd / kp, d / p)
            of_all = _settling(other, estimate, box).mean(axis=0)
            ratio.append((of_all[-1], of_all.min()))
    late = [own / best for own, best in mean]
    if max(late) < _WORSE:
        return None
    if (
        len(ratio) == len(answers)
        and np.median(late) > 1.1
        and all(own < 1.06 * best for own, best in ratio)
        and min(best for _, best in ratio) < 2.75
    ):
        return "ROLLOUT_GIVEN_RATIO"
    if max(late) > 1.12 and max(own / best for own, best in tail) < 1.1:
        return "SLOW_TAIL"
    slowest = [own / best for own, best in most if best < 2.4]
    tied = {pair for pair, (_, best) in zip(answers, most, strict=True) if best >= 3.0}
    if slowest and max(slowest) < 1.2 and np.median(slowest) < 1.06 and len(tied) <= 1:
        return "WORST_CART"
    if not slowest and len(tied) == 1:
        return "TIED"
    medians = [own / best for own, best in middle if best < 2.9]
    if len(medians) > 1 and max(medians) < 1.08 and max(late) > 1.12:
        return "MEDIAN_CART"
    return None


def _follows(pairs, estimates):
    """Whether kd is the same in each answer, or in the same proportion to kp or to the root of kp m.

    A proportion at the edge of the README's grid is where a search ended.
    """
    kp, kd = np.array(pairs).T
    m, b = (np.array([estimate[name][0] for estimate in estimates]) for name in ("m", "b"))
    if np.ptp(kp) < 1e-3 * np.max(kp):
        return False
    root, inside = np.sqrt(kp * m), 0.27 < kd[0] / kp[0] < 0.68
    laws = (kd, *([kd / kp] if inside else []), kd / root, (kd + b) / root)
    return any(np.ptp(x) < 1e-6 * np.max(np.abs(x)) for x in laws)


def _unread(submission, estimate, box, gains):
    """What of the question makes no difference to the gains, or one that it must not make; a code or None.

    What seems to make none is tried again the other way and further off, where no grid is too coarse.
    """

    def same(*asked):
        found = kit.attempt(lambda: [gains_of(each) for each in submission.call_each("tune", list(asked))])
        return None if found is None else [pair == gains for pair in found]

    def lows(change):
        return estimate, {k: [change(*ends), ends[1]] for k, ends in box.items()}

    def highs_read():
        wider = {k: [low, low + 3 * (high - low)] for k, (low, high) in box.items()}
        return same((estimate, wider)) == [False]

    def shifted(name, factor):
        return estimate, {**box, name: [factor * end for end in box[name]]}

    def widened(times):
        middles = {k: math.sqrt(low * high) for k, (low, high) in box.items()}
        return estimate, {k: [x * (end / x) ** times for end in box[k]] for k, x in middles.items()}

    lag = {**estimate, "lag": [2.0 * x for x in estimate["lag"]]}, box
    kept = same(lag, lag, shifted("m", 1.8), shifted("latency", 1.8), lows(lambda low, high: low / 3))
    if kept is None:  # no time was left for so many calls
        return None
    if kept[:2] == [False, False]:
        return "LAG_READ" if all(same((estimate, box), (estimate, box)) or [False]) else None
    corner = {k: [high, high] for k, (_, high) in box.items()}
    tries = (
        ("RANGE_NOT_READ", kept[2], [shifted("m", f) for f in (0.25, 4.0)]),
        ("RANGE_NOT_READ", kept[3], [shifted("latency", f) for f in (0.25, 4.0)]),
        # The soonest or the slowest of all carts may be at one end, too: its gains are others.
        (
            "LOWS_NOT_READ",
            kept[4] and not kept[2] and _is_best(*gains, estimate, corner) and highs_read(),
            [lows(lambda low, high: 0.9 * high)],
        ),
        ("WIDTH_NOT_READ", not (kept[2] and kept[3]), [widened(times) for times in (0.2, 0.0, 1.6)]),
    )
    return next((code for code, seen, again in tries if seen and all(same(*again) or [False])), None)


def _of_failing(gains, estimate, box):
    """What gains do well with which most of the carts never settle, as a code, or None."""
    kp, kd = _grid()
    times = _settling((np.append(kp, gains[0]), np.append(kd, gains[1])), estimate, box)
    never = times >= 3.0
    failing = float(np.mean(never[:, -1]))
    if failing <= 0.5:
        return None
    if failing == 1.0:
        return "NO_CART_SETTLES"
    first, best = times.min(axis=0), times.mean(axis=0).argmin()
    settled = np.where(never, 0.0, times).sum(axis=0) / np.maximum(np.sum(~never, axis=0), 1)
    settled[never.all(axis=0)] = 3.0
    soonest = any(each[-1] < 0.9 * each[best] for each in (first, settled))
    return "FAILURES_LEFT_OUT" if soonest else None


def _never_changes(submission, estimate, box, gains):
    """Whether carts twenty times as heavy, or a fifth, get these gains too: no grid is so coarse."""
    asked = [(_with(estimate, ("m", "b", "Fc"), factor), box) for factor in (20.0, 0.2)]
    far = kit.attempt(lambda: [gains_of(each) for each in submission.call_each("tune", asked)])
    return far is not None and all(pair == gains for pair in far)


def _are_ratios(pairs):
    """Whether each kd is of the size of a good ratio kd/kp, and does not grow with kp as a gain does."""
    (most, with_most), (least, with_least) = max(pairs), min(pairs)
    return (
        all(0.2 < kd < 1.0 < kp for kp, kd in pairs)
        and most > 1.3 * least
        and with_most / with_least < math.sqrt(most / least)
    )


def _would_do(kp, kd, gains, estimate, box, success):
    """Whether these gains are right and do far better than those that came."""
    return success(kp, kd) > 1.2 * success(*gains) and _is_best(kp, kd, estimate, box)


#: How a box is shifted to see whether it is read: a load, and everything later.
_LOAD = {"m": 2.0, "latency": 1.8, "tau": 1.5}


def _with(estimate, names, factor):
    return {k: [factor * x for x in v] if k in names else v for k, v in estimate.items()}


_AROUND = [(a, b) for a in (1.0, 0.6, 1.6) for b in (1.0, 0.6, 1.6)]  # (1, 1) first: the gains themselves


def _better(gains, success):
    """The best of some gains about these."""
    kp, kd = gains
    return max(((kp * a, kd * b) for a, b in _AROUND), key=lambda pair: success(*pair))


def _grid():
    """Pairs of gains over the README's range, (80,) each."""
    kp, ratio = (x.ravel() for x in np.meshgrid(np.geomspace(2, 40, 10), np.linspace(0.2, 0.75, 8)))
    return kp, kp * ratio


def _best_of_grid(estimate, box):
    """The best of them on a hundred carts of the box: a search that ended early may have ended far off."""
    kp, kd = _grid()
    best = int(_settling((kp, kd), estimate, box).mean(axis=0).argmin())
    return float(kp[best]), float(kd[best])


def _is_best(kp, kd, estimate, box, most=3.0):
    """Whether no gains around (kp, kd) do clearly better on carts drawn from the box about the estimate.

    Where hardly a cart settles, gains are as good as any around them, and suit none: they have to settle
    within ``most``, s, in the mean.
    """
    factors = np.array(_AROUND).T
    mean = _settling((kp * factors[0], kd * factors[1]), estimate, box).mean(axis=0)
    return bool(mean.min() > 0.85 * mean[0] and mean[0] < most)


def _settling(gains, estimate, box):
    """Settling times on a hundred carts drawn from the box about the estimate, (100, G), s."""
    value, factor = _drawn(estimate, box, 100)
    return cart.rollout(*gains, {k: value[k] * factor[k] for k in NAMES}, np.random.default_rng(32))


def _drawn(estimate, box, count, *, once=False):
    """The estimate's values, and as many factors on each, (count,); ``once``: of all the same share."""
    share = (cart.stratified(count, np.random.default_rng(31)) + 1) / 2
    ends = [np.log(box[k]) for k in NAMES]
    return {k: estimate[k][0] for k in NAMES}, {
        k: np.exp(low + share[:, 0 if once else j] * (high - low))
        for j, (k, (low, high)) in enumerate(zip(NAMES, ends, strict=True))
    }


#: Carts drawn in a wrong way: v are the values of the estimate, f factors on them, once those of one draw.
_OTHER_CARTS = {
    "ONE_DRAW_FOR_ALL": lambda v, f, once, box: {k: v[k] * once[k] for k in NAMES},
    "BOX_ENDS_ALONE": lambda v, f, once, box: {
        k: v[k] * np.where(f[k] < math.sqrt(box[k][0] * box[k][1]), *box[k]) for k in NAMES
    },
    "FACTORS_DIVIDE": lambda v, f, once, box: {k: v[k] / f[k] for k in NAMES},
    "FACTORS_ADDED": lambda v, f, once, box: {k: v[k] * (1 + f[k]) for k in NAMES},
    "LAG_FOR_LATENCY": lambda v, f, once, box: {
        k: (v[k] + v["tau"] * (k == "latency")) * f[k] for k in NAMES
    },
}
#: How much later than the best of a grid: gains that are meant for such carts settle on them at most 1.03
#: times as late, on the right ones 1.1 times for one question at least.
_AS_GOOD, _WORSE = 1.04, 1.08


def _best_for_others(questions, answers):
    """Which wrongly drawn carts these gains are all as good as the best for, as a code, or None."""

    def lateness(asked, gains, draw):
        """The mean settling time over the best of the grid, on fifty carts; 1 where hardly one settles."""
        estimate, box = asked
        value, factor = _drawn(estimate, box, 50)
        carts = draw(value, factor, _drawn(estimate, box, 50, once=True)[1], box)
        pairs = (np.append(all_, one) for all_, one in zip(_grid(), gains, strict=True))
        mean = cart.rollout(*pairs, carts, np.random.default_rng(32)).mean(axis=0)
        return mean[-1] / mean.min() if mean.min() < 2.5 else 1.0

    pairs = list(zip(questions, answers, strict=True))
    if all(lateness(*pair, lambda v, f, *_: {k: v[k] * f[k] for k in NAMES}) < _WORSE for pair in pairs):
        return None
    fitting = [
        code
        for code, draw in _OTHER_CARTS.items()
        if all(lateness(*pair, draw) <= _AS_GOOD for pair in pairs)
    ]
    return fitting[0] if len(fitting) == 1 else None
