"""Mistakes in `sim-to-real`: words beside the programs that they are true of."""

from __future__ import annotations

import itertools
import math

import numpy as np

from course.authoring.mistakes import Mistakes
from course.scoring import kit

mistakes = Mistakes()

#: How m, b, Fc and the times follow from the best fit of a search, with the intervals of the model solution.
_FROM_BEST = """\
        _, tau, late, theta = best
        m = 1 / theta[0]
        found = {"m": m, "b": -theta[1] * m, "Fc": -theta[2] * m, "tau": tau, "latency": late, "lag": tau + late}
        half = {k: e[2] - e[0] for k, e in _right(t, u, y).items()}
        return {k: [float(x), float(x - half[k]), float(x + half[k])] for k, x in found.items()}
"""


def _by_search(columns):
    """The text of an ``identify`` that fits these columns over the grid of both times."""
    return f"""
        Y = in_blocks(y).reshape(-1)
        best = None
        for tau in np.arange(0.02, 0.151, 0.01):
            impulse = motor_impulse(u, tau)
            for late in np.arange(0.02, 0.201, 0.01):
                columns = [{columns}]
                theta, left, *_ = np.linalg.lstsq(in_blocks(np.stack(columns, axis=1)).reshape(-1, 3), Y)
                if best is None or left[0] < best[0]:
                    best = left[0], tau, late, theta
{_FROM_BEST}"""


mistakes(
    "BOX_TOO_WIDE",
    "For at least one parameter the box is, in the logarithm, more than 1.5 times as wide as the fleet, so it contains carts that the fleet does not have.",
    "Take the fleet's own spread for every parameter, from e^-w to e^w for a half-width w.",
    kind="fact",
).around(
    "plan",
    """
        made = _right()
        made["randomization"] = {k: [math.exp(-3 * w), math.exp(3 * w)] for k, w in LOG_WIDTH.items()}
        return made
    """,
)
mistakes(
    "BOX_TOO_NARROW",
    "More than 5 % of the fleet lies outside the box for at least one parameter.",
    "Give factors on the estimate that hold the fleet: for every parameter from e^-w to e^w, for a half-width w.",
    kind="fact",
).around(
    "plan",
    """
        made = _right()
        made["randomization"] = {k: [1.0, 1.0] for k in NAMES}
        return made
    """,
).around(
    "plan",
    """
        found = _right()
        return {**found, "randomization": {**found["randomization"], "m": [0.99, 1.01], "b": [0.2, 5.0]}}
    """,
)
mistakes(
    "BOX_HALF_LINEAR",
    "The low ends of the box are e^-w, and its high ends are 1 + w.",
    "The half-width w is one in the logarithm on both sides: the high ends are e^w.",
    kind="fact",
).around(
    "plan",
    """
        made = _right()
        made["randomization"] = {k: [math.exp(-w), 1 + w] for k, w in LOG_WIDTH.items()}
        return made
    """,
)
mistakes(
    "BOX_EXCHANGED",
    "The widths of the box are those of the fleet, but some belong to another parameter.",
    "Go through the README's table row by row: each parameter has its own w, and its range is e^-w to e^w.",
    kind="fact",
).around(
    "plan",
    """
        made = _right()
        widths = dict(zip(sorted(NAMES), LOG_WIDTH.values()))
        made["randomization"] = {k: [math.exp(-w), math.exp(w)] for k, w in widths.items()}
        return made
    """,
)
mistakes(
    "BOX_FULL_WIDTH",
    "In the logarithm the box is half as wide as the fleet for every parameter, as if w were the whole width.",
    "w is the half-width: the factors go from e^-w to e^w.",
    kind="fact",
).around(
    "plan",
    """
        made = _right()
        made["randomization"] = {k: [math.exp(-w / 2), math.exp(w / 2)] for k, w in LOG_WIDTH.items()}
        return made
    """,
)
mistakes(
    "BOX_TWICE_AS_WIDE",
    "In the logarithm the box is about twice as wide as the fleet for every parameter, as if w were a standard deviation.",
    "The whole fleet lies between e^-w and e^w: take these factors.",
    kind="fact",
).around(
    "plan",
    """
        made = _right()
        made["randomization"] = {k: [math.exp(-2 * w), math.exp(2 * w)] for k, w in LOG_WIDTH.items()}
        return made
    """,
)
mistakes(
    "BOX_ONE_SIDED",
    "The box lies on one side only: one end of each range is the estimate itself.",
    "The fleet lies on both sides of its cart: the factors go from e^-w to e^w.",
    kind="fact",
).around(
    "plan",
    """
        made = _right()
        made["randomization"] = {k: [1.0, math.exp(w)] for k, w in LOG_WIDTH.items()}
        return made
    """,
)
mistakes(
    "BOX_IS_LINEAR",
    "The box goes from 1 - w to 1 + w: the half-width is used as a fraction.",
    "The fleet's spread is given for the logarithm, so the factors go from e^-w to e^w, which is not symmetric about 1.",
    kind="fact",
).around(
    "plan",
    """
        made = _right()
        made["randomization"] = {k: [1 - w, 1 + w] for k, w in LOG_WIDTH.items()}
        return made
    """,
)
mistakes(
    "BOX_NOT_FACTORS",
    "The middles of the box are close to the data sheet's values, as if it contained the parameters in their own units.",
    "Give factors that multiply the estimate, from e^-w to e^w for a half-width w. The estimate itself is not known when the plan is written.",
    kind="fact",
).around(
    "plan",
    """
        made = _right()
        sheet = {"m": 1.5, "b": 0.6, "Fc": 0.4, "tau": 0.06, "latency": 0.08}
        made["randomization"] = {
            k: [sheet[k] * math.exp(-w), sheet[k] * math.exp(w)] for k, w in LOG_WIDTH.items()
        }
        return made
    """,
)
mistakes(
    "BOX_IN_LOGARITHMS",
    "An interval of the box goes from a negative number to the same positive one, as a logarithm or a deviation does.",
    "The numbers in randomization multiply the estimate: for a half-width w in the logarithm they are e^-w and e^w.",
    kind="fact",
).around(
    "plan",
    """
        made = _right()
        made["randomization"] = {k: [-w, w] for k, w in LOG_WIDTH.items()}
        return made
    """,
)
mistakes(
    "EXCITATION_CANNOT_SHOW",
    "Even in all of the bench time, this excitation does not show the parameter well enough.",
    "Ask what would change in the recording if the parameter were larger. chirp and prbs show every parameter of the cart; noise shows at rest.",
    kind="fact",
).around(
    "plan",
    """
        made = _right()
        made["gaps"][3]["excitation"] = "constant"
        return made
    """,
).around(
    "plan",
    """
        made = _right()
        made["gaps"][4]["excitation"] = "prbs"
        return made
    """,
)
mistakes(
    "PROMISES_TOO_MUCH",
    "No estimator can reach this threshold with this excitation in this time.",
    'Check the unit first: 0.1 with "%" is a tenth of a per cent. Else take a larger threshold, up to what the README asks of that parameter: what your own identify returns for such recordings is a guide.',
    kind="fact",
).around(
    "plan",
    """
        made = _right()
        made["gaps"][1]["threshold"] = 0.01
        return made
    """,
)
mistakes(
    "PROMISES_TOO_MUCH_OF_NOISE",
    "No estimator can know the noise as well as this from so many samples.",
    "From n samples at rest, the standard deviation has a 95 % interval of half-width 1.96/sqrt(2 n), as a share. Take a threshold between that and the README's limit.",
    kind="fact",
).around(
    "plan",
    """
        made = _right()
        made["gaps"][4]["threshold"] = 3.0
        return made
    """,
)
mistakes(
    "PROMISES_TOO_LITTLE",
    "Even a measurement too coarse to be useful would meet this threshold.",
    'The README says how exactly each parameter must be known; a threshold above that decides nothing. Check the unit too: 3 % is 3 with "%" and 0.03 with "1".',
    kind="fact",
).around(
    "plan",
    """
        made = _right()
        made["gaps"][0]["threshold"] = 50.0
        return made
    """,
)
mistakes(
    "BUDGET_EXCEEDED",
    "The plan's bench time is zero or negative, or more than there is.",
    "excitation_budget_s must be positive, and at most the time for which the README says the bench is free.",
    kind="fact",
).around(
    "plan",
    """
        made = _right()
        made["excitation_budget_s"] = 60.0
        return made
    """,
)
mistakes(
    "BUDGET_TOO_SHORT",
    "In all of the bench time this excitation would show the parameter well enough, but not in the time that the plan takes.",
    "More bench time is available: raise excitation_budget_s.",
    kind="fact",
).around(
    "plan",
    """
        made = _right()
        made["excitation_budget_s"] = 0.5
        return made
    """,
)
mistakes(
    "TOO_FEW_SOURCES",
    "All gaps of the plan have the same one or two sources.",
    "This cart has the sources friction, actuator_lag, delay, sensor_noise and environment. Use at least three of them.",
    kind="fact",
).around(
    "plan",
    """
        made = _right()
        made["gaps"] = [made["gaps"][1], made["gaps"][2], {**made["gaps"][2], "excitation": "chirp"}]
        return made
    """,
)
mistakes(
    "SOURCE_NOT_HERE",
    "The plan spends bench time on gear backlash, but this cart has no gears.",
    "A source counts only where it exists. Read how the cart is built, and take sources that it has.",
    kind="fact",
).around(
    "plan",
    """
        made = _right()
        made["gaps"][4] = {**made["gaps"][4], "source": "gear_backlash", "parameter": "play"}
        return made
    """,
)
mistakes(
    "EXCITATION_CONSTANT",
    "In at least one recording the force changes at most twice after its first command, and a delay shows only where it changes.",
    "Reverse the force many times, at irregular intervals.",
).body("design_excitation", "return np.full(round(100 * budget_s), u_max)").body(
    "design_excitation",
    """
        n = round(100 * budget_s)
        return np.concatenate([np.zeros(n // 2), np.full(n - n // 2, u_max)])
    """,
)
mistakes(
    "EXCITATION_TOO_SLOW",
    "More than two thirds of the force's power lies below 0.3 Hz, in swings of seconds; the lag is about a tenth of a second.",
    "Add changes as quick as the effects that you want to see: several within a second. Full force, reversed after a random 0.1 to 0.6 s, has slow and quick ones.",
).body(
    "design_excitation", "return u_max * np.sin(2 * np.pi * 0.01 * np.arange(round(100 * budget_s)) / 100)"
).body(
    "design_excitation", "return u_max * np.sin(2 * np.pi * 0.05 * np.arange(round(100 * budget_s)) / 100)"
)
mistakes(
    "EXCITATION_TOO_FAST",
    "More than two thirds of the power in the force's changes lies above 4 Hz, where the motor's lag and the mass average most of it out.",
    "Hold each command long enough for the cart to pick up speed: a few tenths of a second. If your signal is made of sines, take lower frequencies.",
).body("design_excitation", "return rng.uniform(-u_max, u_max, round(100 * budget_s))")
mistakes(
    "EXCITATION_SATURATES",
    "The largest force of the signal is above u_max.",
    "Make a new signal in each call, and scale it so that its largest absolute value is the u_max of that call.",
    kind="fact",
).body(
    "design_excitation",
    """
        t = np.arange(round(100 * budget_s)) / 100
        u = sum(np.sin(2 * np.pi * f * t + rng.uniform(0, 7)) for f in np.arange(0.1, 2.0, 0.1))
        return u_max * u / np.std(u)
    """,
).program(
    "design_excitation",
    """
        _design = design_excitation
        _KEPT = {}


        def design_excitation(budget_s, u_max, rng):
            if budget_s not in _KEPT:
                _KEPT[budget_s] = _design(budget_s, u_max, rng)
            return _KEPT[budget_s].copy()
    """,
)
mistakes(
    "EXCITATION_TOO_WEAK",
    "The largest force is less than half of what the bench can give, so the noise hides more than it has to.",
    "Use all of u_max: the noise stays the same, so the motion stands out more clearly.",
).around("design_excitation", "return 0.16 * _right(budget_s, u_max, rng)")
mistakes(
    "EXCITATION_BLIND",
    "From what this signal makes a cart do, at least one parameter comes out too uncertain.",
    "Mix quick changes, which show mass and lag, with longer pushes, which show the two kinds of friction at different speeds. Full force, reversed after a random 0.1 to 0.6 s, has both.",
    kind="consequence",
).body(
    "design_excitation",
    """
        t = np.arange(round(100 * budget_s)) / 100
        return u_max * np.sin(2 * np.pi * (2.0 * t + 0.01 * t * t))
    """,
)
mistakes(
    "EXCITATION_ONE_RATE",
    "The force swings back and forth at one rate from beginning to end.",
    "One rate tells little more than how far the speed goes up and down, and how late. Mix quick changes with longer pushes: full force, reversed after a random 0.1 to 0.6 s, has both.",
    kind="fact",
).body(
    "design_excitation", "return u_max * np.sin(2 * np.pi * 2.0 * np.arange(round(100 * budget_s)) / 100)"
).body("design_excitation", "return np.where(np.arange(round(100 * budget_s)) // 20 % 2 == 0, u_max, -u_max)")
mistakes(
    "EXCITATION_MOSTLY_WEAK",
    "For more than 40 % of the time the force is below half of u_max. With the same signs and full force all the time, the signal would show enough.",
    "Push with full force from beginning to end, one way or the other: the noise is the same all the time.",
).body(
    "design_excitation",
    """
        t = np.arange(round(100 * budget_s)) / 100
        return u_max * (np.sin(2 * np.pi * 1.9 * t) + np.sin(2 * np.pi * 2.4 * t)) / 2
    """,
)
mistakes(
    "WRONG_LENGTH",
    "The number of commands is not the duration times the rate.",
    "Return round(100 * budget_s) commands for any budget_s, and cut what is longer: int() can lose one, and np.arange can give one more.",
    kind="fact",
).body("design_excitation", "return u_max * rng.choice([-1.0, 1.0], round(budget_s))").around(
    "design_excitation", "return _right(budget_s, u_max, rng)[: int(100 * budget_s)]"
).around(
    "design_excitation",
    """
        times = np.arange(0, budget_s, 0.01)
        return np.resize(_right(budget_s, u_max, rng), len(times))
    """,
)
mistakes(
    "COULOMB_AS_VISCOUS",
    "Fc comes out far too small and b too large, as if viscous friction stood for both.",
    "Give each its own column: the integral of the speed for b, the integral of its sign for Fc. If they are there, compare them with the README's.",
).around(
    "identify",
    """
        found = _right(t, u, y)
        impulse = motor_impulse(u, found["tau"][0])
        X = np.stack([delayed(impulse, found["latency"][0]), cumulative(y)], axis=1)
        theta = np.linalg.lstsq(in_blocks(X).reshape(-1, 2), in_blocks(y).reshape(-1))[0]
        m, b = 1 / theta[0], -theta[1] / theta[0]
        return {**found, "m": [m, 0.99 * m, 1.01 * m], "b": [b, 0.9 * b, 1.1 * b], "Fc": [0.0, -0.05, 0.05]}
    """,
)
mistakes(
    "SIGN_OF_COMMAND",
    "With your tau and latency, m, b and Fc are those of a fit whose column for Fc is made of the sign of the command or the force, not of the speed.",
    "Friction acts against the motion: take cumulative(np.sign(y)), with the measured speed y, not the command u.",
).around(
    "identify",
    _by_search("delayed(impulse, late), cumulative(y), cumulative(np.sign(u))"),
).around(
    "identify",
    _by_search("delayed(impulse, late), cumulative(y), delayed(cumulative(np.sign(u)), late)"),
)
mistakes(
    "FRICTION_DELAYED",
    "With your tau and latency, m, b and Fc are those of a fit in which the columns of friction are delayed too.",
    "Only the command is late. The speed is measured without delay: take cumulative(y) and cumulative(np.sign(y)) as they are.",
).around(
    "identify",
    _by_search("*(delayed(one, late) for one in (impulse, cumulative(y), cumulative(np.sign(y))))"),
)
mistakes(
    "SIGN_OF_POSITION",
    "With your tau and latency, m, b and Fc are those of a fit whose column for Fc is the sign of the integral of the speed.",
    "Take the sign first, and then the integral: cumulative(np.sign(y)).",
).around(
    "identify",
    _by_search("delayed(impulse, late), cumulative(y), np.sign(cumulative(y))"),
)
mistakes(
    "SIGN_WITH_DEAD_BAND",
    "With your tau and latency, m, b and Fc are those of a fit in which the sign of a slow speed counts as zero.",
    "Take np.sign(y) of every sample, slow ones too.",
).around(
    "identify",
    _by_search(
        "delayed(impulse, late), cumulative(y), cumulative(np.where(np.abs(y) > 0.1, np.sign(y), 0.0))"
    ),
)
mistakes(
    "OTHER_FIT",
    "The README's fit with your tau and latency gives good values of m, b and Fc; yours are others.",
    "Look at the fit itself: its three columns, in_blocks of every column and of y, least squares without weights or a penalty, and m = 1/theta[0], b = -theta[1] m, Fc = -theta[2] m.",
    kind="fact",
).around(
    "identify",
    """
        found = _right(t, u, y)
        columns = [delayed(motor_impulse(u, found["tau"][0]), found["latency"][0]), cumulative(y), cumulative(np.sign(y))]
        X = in_blocks(np.stack(columns, axis=1)).reshape(-1, 3)
        theta = np.linalg.solve(X.T @ X + 8.0 * np.eye(3), X.T @ in_blocks(y).reshape(-1))
        for name, value in zip(("m", "b", "Fc"), (1.0, -theta[1], -theta[2])):
            half = found[name][2] - found[name][0]
            found[name] = [float(value / theta[0]), float(value / theta[0] - half), float(value / theta[0] + half)]
        return found
    """,
)
mistakes(
    "BLOCKS_WITHOUT_CONSTANT",
    "With your tau and latency, m, b and Fc are those of a fit in which the blocks have no constants of their own.",
    "The speed at the start of a block is not known exactly, and the integrals drift: put y and every column through in_blocks, which takes each block's mean away.",
).program(
    "identify",
    """
        def in_blocks(x, size=100):
            count = len(x) // size
            return np.reshape(x[: count * size], (count, size, -1))
    """,
).around(
    "identify",
    """
        rubbed = [cumulative(y), cumulative(np.sign(y))]
        best = None
        for tau in np.arange(0.02, 0.151, 0.01):
            impulse = motor_impulse(u, tau)
            for late in np.arange(0.02, 0.201, 0.01):
                X = np.stack([delayed(impulse, late), *rubbed], axis=1)
                X = X - X[np.arange(len(y)) // 100 * 100]
                theta, left, *_ = np.linalg.lstsq(X, y)
                if best is None or left[0] < best[0]:
                    best = left[0], tau, late, theta
"""
    + _FROM_BEST,
)
mistakes(
    "BLOCKS_FROM_FIRST",
    "With your tau and latency, m, b and Fc are those of a fit in which each block is counted from its first sample.",
    "The first sample has noise, and so all of its block is off: take each block's mean away from y and from every column, as in_blocks does.",
).program(
    "identify",
    """
        def in_blocks(x, size=100):
            count = len(x) // size
            blocks = np.reshape(x[: count * size], (count, size, -1))
            return blocks - blocks[:, :1]
    """,
)
mistakes(
    "SIGN_NOT_INTEGRATED",
    "With your tau and latency, m, b and Fc are those of a fit whose column for Fc is the sign of the speed itself, not its integral.",
    "All columns are integrals: take cumulative(np.sign(y)).",
).around(
    "identify",
    _by_search("delayed(impulse, late), cumulative(y), np.sign(y)"),
)
mistakes(
    "ACCELERATION_FITTED",
    "With your tau and latency, m, b and Fc are those of a fit to the acceleration, got by differentiating the measured speed.",
    "Do not differentiate: its noise makes every value scatter. Fit the speed itself, with the integrals of force, speed and sign of the speed.",
).program(
    "identify",
    """
        def identify(t, u, y):
            a = np.gradient(y, H)
            best = None
            for tau in np.arange(0.02, 0.151, 0.01):
                force = np.gradient(motor_impulse(u, tau), H)
                for late in np.arange(0.02, 0.201, 0.01):
                    X = np.stack([delayed(force, late), -y, -np.sign(y)], axis=1)
                    theta, left, *_ = np.linalg.lstsq(X, a)
                    if best is None or left[0] < best[0]:
                        best = left[0], tau, late, theta, X
            left, tau, late, theta, X = best
            rel = 1.96 * np.sqrt(np.diag(np.linalg.inv(X.T @ X)) * left / len(a)) / np.abs(theta)
            m = 1 / theta[0]
            values = {"m": m, "b": theta[1] * m, "Fc": theta[2] * m, "tau": tau, "latency": late, "lag": tau + late}
            shares = dict(zip(("m", "b", "Fc"), rel))
            return {
                k: [float(x), float(x * (1 - shares.get(k, 0.05))), float(x * (1 + shares.get(k, 0.05)))]
                for k, x in values.items()
            }
    """,
)
mistakes(
    "LAG_TOO_LONG",
    "For all of these carts the lag comes out too long by about the same time.",
    "Fit y as it was recorded: a filter that looks back only makes it late. If you do, see that no sample of y is shifted to a later time against u.",
    kind="fact",
).around(
    "identify",
    """
        smooth = np.array(y, dtype=float)
        for k in range(1, len(smooth)):
            smooth[k] = smooth[k - 1] + 0.3 * (smooth[k] - smooth[k - 1])
        return _right(t, u, smooth)
    """,
)
mistakes(
    "LAG_TOO_SHORT",
    "For all of these carts the lag comes out too short by about the same time.",
    "Sample k of u is commanded from sample k of y on: shift neither against the other, except for the latency that you search.",
    kind="fact",
).around("identify", "return _right(t[:-3], np.concatenate([np.zeros(3), u[:-6]]), y[:-3])")
mistakes(
    "TIMES_NOT_BEST",
    "m, b and Fc are those of the README's fit with your tau and latency. In most of these recordings its misfit is smaller with the cart's own times.",
    "The search misses the best pair of times: search the whole grid, then refine around its best pair with smaller and smaller steps.",
).around(
    "identify",
    """
        Y = in_blocks(y).reshape(-1)

        def fit(tau, late):
            columns = [delayed(motor_impulse(u, tau), late), cumulative(y), cumulative(np.sign(y))]
            theta, left, *_ = np.linalg.lstsq(in_blocks(np.stack(columns, axis=1)).reshape(-1, 3), Y)
            return left[0], tau, late, theta

        late = min((fit(0.02, late) for late in np.arange(0.02, 0.201, 0.002)), key=lambda each: each[0])[2]
        best = min((fit(tau, late) for tau in np.arange(0.02, 0.151, 0.002)), key=lambda each: each[0])
"""
    + _FROM_BEST,
    also=("PARAMETER_FIXED", ""),
)
mistakes(
    "TIMES_NEAR_SHEET",
    "The lags of carts whose times are like the data sheet's are right. Here tau and latency are both far longer, or far shorter.",
    "Search tau from 0.02 to 0.15 s and latency from 0.02 to 0.20 s, and let the refinement go as far.",
    kind="fact",
).edit(
    "identify",
    {
        "np.arange(0.02, 0.151, 0.02)": "np.arange(0.04, 0.091, 0.01)",
        "value = _parameters(theta, *start)": "value = _parameters(theta, *start)\n        value[3:5] = np.clip(value[3:5], [0.03, 0.05], [0.1, 0.13])\n        value[5] = value[3] + value[4]",
    },
)
mistakes(
    "LATENCY_IGNORED",
    "The latency comes out as nearly zero, as if commands arrived at once.",
    "Shift the impulse by each latency from 0.02 to 0.20 s with `delayed`, fit, and keep the one with the smallest residual. If you do, compare the columns of the fit with the README's.",
).body(
    "identify",
    """
        Y = in_blocks(y).reshape(-1)
        best = None
        for tau in np.arange(0.02, 0.151, 0.005):
            X = np.stack([motor_impulse(u, tau), cumulative(y), cumulative(np.sign(y))], axis=1)
            theta, left, *_ = np.linalg.lstsq(in_blocks(X).reshape(-1, 3), Y)
            if best is None or left[0] < best[0]:
                best = left[0], tau, theta
        _, tau, theta = best
        m = 1 / theta[0]
        values = {"m": m, "b": -theta[1] * m, "Fc": -theta[2] * m, "tau": tau, "latency": 0.0, "lag": tau}
        return {k: [float(x), float(0.98 * x), float(1.02 * x)] for k, x in values.items()}
    """,
)
mistakes(
    "INTERVAL_OVERCONFIDENT",
    "The intervals are too narrow, at least on one side, for how far the values are off.",
    "Leave out one block at a time and refit everything, the times too. The standard error is sqrt((n-1)/n * sum((each - mean)**2)), and 2.1 of it on either side make a 95 % interval. If yours are made so, see how far the values are off on carts that you know: times that stay on a grid, or end at its edge, are off.",
    kind="fact",
).edit(
    "identify",
    {
        "X = in_blocks(np.stack(columns, axis=1))": "X = in_blocks(np.stack(columns, axis=1), 50)",
        "in_blocks(y))[..., 0]": "in_blocks(y, 50))[..., 0]",
        "half = 2.1": "half = 0.21",
    },
)
mistakes(
    "INTERVAL_BY_FORMULA",
    "In each recording the interval of m is as wide as the usual formula makes it, which takes the samples' errors for independent.",
    "The errors are not independent: use the jackknife. Leave out one block at a time and refit everything, the times too.",
).around(
    "identify",
    """
        found = {k: entry[0] for k, entry in _right(t, u, y).items()}
        X = np.stack(
            [delayed(motor_impulse(u, found["tau"]), found["latency"]), cumulative(y), cumulative(np.sign(y))],
            axis=1,
        )
        theta, left, *_ = np.linalg.lstsq(X, y)
        spread = np.sqrt(np.diag(np.linalg.inv(X.T @ X)) * left[0] / (len(y) - 3))
        rel = 1.96 * spread / abs(theta)
        rel = {"m": rel[0], "b": rel[1], "Fc": rel[2], "tau": 0.002, "latency": 0.002, "lag": 0.0007}
        return {k: [x, float(x * (1 - rel[k])), float(x * (1 + rel[k]))] for k, x in found.items()}
    """,
)
mistakes(
    "INTERVAL_PLAIN_SPREAD",
    "The intervals are as narrow as the plain spread of the jackknife's refits makes them, without the factor n - 1.",
    "The refits share all blocks but one, so they are much alike. The standard error is sqrt((n-1)/n * sum((each - mean)**2)): neither np.std nor np.std over the root of n.",
).around(
    "identify",
    """
        n = len(y) // 100
        shrink = math.sqrt(n) / (n - 1)  # from sqrt((n-1)/n * sum) to sqrt(sum/(n-1))
        return {
            k: [x, x + shrink * (low - x), x + shrink * (high - x)]
            for k, (x, low, high) in _right(t, u, y).items()
        }
    """,
).edit(
    "identify",
    {
        "np.sqrt((n - 1) / n * np.sum((each - each.mean(axis=0)) ** 2, axis=0))": "np.std(each, axis=0) / np.sqrt(n)"
    },
)
mistakes(
    "INTERVAL_ROOT_MISSING",
    "The half-widths are those of the jackknife's formula without its square root.",
    "The standard error is sqrt((n-1)/n * sum((each - mean)**2)), and 2.1 of it on either side make a 95 % interval.",
).edit(
    "identify",
    {
        "np.sqrt((n - 1) / n * np.sum((each - each.mean(axis=0)) ** 2, axis=0))": "(n - 1) / n * np.sum((each - each.mean(axis=0)) ** 2, axis=0)"
    },
)
mistakes(
    "INTERVAL_ONE_ERROR",
    "The intervals reach about one standard error of the jackknife to either side, half as far as 95 % needs.",
    "A 95 % interval goes 2.1 standard errors to either side of the value.",
).edit("identify", {"half = 2.1 * np.sqrt": "half = np.sqrt"})
mistakes(
    "INTERVAL_OF_INVERSE",
    "The half-width of m is that of 1/m.",
    "Turn the theta of each refit into m, b and Fc first, and take the spread of these.",
).edit(
    "identify",
    {
        "names = (*NAMES": "half[0] = 2.1 * np.sqrt((n - 1) / n * np.sum((left_out[:, 0] - left_out[:, 0].mean()) ** 2))\n    names = (*NAMES"
    },
)
mistakes(
    "TIMES_HELD",
    "The intervals of m, b and Fc are as wide as when each refit keeps the tau and latency of the whole recording.",
    "Find tau and latency anew in each refit, between the points of the grid: refine around their values, or fit the two more columns of a hint.",
).edit(
    "identify",
    {
        "left_out = np.linalg.solve(XX.sum(axis=0) - XX, (Xv.sum(axis=0) - Xv)[..., None])[..., 0]": "left_out = np.linalg.solve((XX.sum(axis=0) - XX)[:, :3, :3], (Xv.sum(axis=0) - Xv)[:, :3, None])[..., 0]\n    left_out = np.hstack([left_out, np.zeros((len(XX), 2))])",
        "names = (*NAMES": "half = np.maximum(half, 0.0005)\n    names = (*NAMES",
    },
)
mistakes(
    "INTERVAL_NARROW",
    "m, b and Fc are those of the README's fit, and from recording to recording they scatter more than the intervals say.",
    "Leave out one block at a time and refit everything, the times too. The standard error is sqrt((n-1)/n * sum((each - mean)**2)), and 2.1 of it on either side make a 95 % interval.",
    kind="fact",
).edit("identify", {"half = 2.1 * np.sqrt": "half = 1.3 * np.sqrt"})
mistakes(
    "BLOCKS_KEPT_OUT",
    "The intervals are as wide as when each refit also lacks the blocks that were left out before.",
    "Put each block back before you leave out the next: every refit uses all blocks but one.",
).edit(
    "identify",
    {
        "XX.sum(axis=0) - XX, (Xv.sum(axis=0) - Xv)[..., None]": "(XX.sum(axis=0) - np.cumsum(XX, axis=0))[:-1], (Xv.sum(axis=0) - np.cumsum(Xv, axis=0))[:-1, :, None]"
    },
)
mistakes(
    "LAG_ENDS_ADDED",
    "The low and high ends of lag are the sums of those of tau and latency.",
    "Compute lag in each refit, and its interval from these: the errors of tau and latency largely cancel in their sum.",
    kind="fact",
).around(
    "identify",
    """
        found = _right(t, u, y)
        return {**found, "lag": [a + b for a, b in zip(found["tau"], found["latency"])]}
    """,
).around(
    "identify",
    """
        found = _right(t, u, y)
        for name in ("tau", "latency"):  # a step of the grid to either side
            x = found[name][0]
            found[name] = [x, x - 0.01, x + 0.01]
        return {**found, "lag": [a + b for a, b in zip(found["tau"], found["latency"])]}
    """,
)
mistakes(
    "LAG_OF_INDEPENDENT_TIMES",
    "The square of the width of lag is the sum of the squares of those of tau and latency, as if their errors were independent.",
    "Compute lag in each refit, and its interval from these: the errors of tau and latency largely cancel in their sum.",
    kind="fact",
).around(
    "identify",
    """
        found = _right(t, u, y)
        x, half = found["lag"][0], math.hypot(*(found[k][2] - found[k][0] for k in ("tau", "latency")))
        return {**found, "lag": [x, x - half, x + half]}
    """,
)
mistakes(
    "INTERVAL_USELESS",
    "An interval is wider than the recording requires.",
    "Each refit of the jackknife uses all blocks but one, and sqrt((n-1)/n * sum((each - mean)**2)) is the standard error of the whole recording. If yours is made so, make the fit scatter less: integrate the equation, fit every sample of y as it was recorded, and refine the times between the points of the grid.",
    kind="consequence",
).around("identify", "return {k: [x, 0.5 * x, 1.5 * x] for k, (x, _, _) in _right(t, u, y).items()}")
mistakes(
    "INTERVAL_REVERSED",
    "An entry is not in the order value, low, high with low <= value <= high.",
    "Each entry is [value, low, high] with low <= value <= high, in the parameter's own unit. low and high are limits, not widths.",
    kind="fact",
).around("identify", "return {k: [x, x - low, high - x] for k, (x, low, high) in _right(t, u, y).items()}")
mistakes(
    "PARAMETER_FIXED",
    "At least one of the parameters comes out the same for every cart that was tried.",
    "m, b and Fc follow from the fit, tau and latency from a search that every call makes anew. Does its grid cover tau from 0.02 to 0.15 s and latency from 0.02 to 0.20 s, and is it refined around the best pair? If a time ends at the edge of that, compare the columns of the fit with the README's.",
).body(
    "identify",
    """
        Y = in_blocks(y).reshape(-1)
        tau, late = 0.05, 0.9

        def fit(late):
            X = np.stack([delayed(motor_impulse(u, tau), late), cumulative(y), cumulative(np.sign(y))], axis=1)
            theta, left, *_ = np.linalg.lstsq(in_blocks(X).reshape(-1, 3), Y)
            return left[0], theta

        best, theta = fit(late)
        step = 0.02
        while step > 0.002:
            trials = [(fit(x), x) for x in (late - step, late + step)]
            (left, other), x = min(trials, key=lambda trial: trial[0][0])
            if left < best:
                best, theta, late = left, other, x
            else:
                step /= 2
        m = 1 / theta[0]
        values = {"m": m, "b": -theta[1] * m, "Fc": -theta[2] * m, "tau": tau, "latency": late, "lag": tau + late}
        return {k: [float(x), float(x - 0.02 * abs(x)), float(x + 0.02 * abs(x))] for k, x in values.items()}
    """,
)
mistakes(
    "COEFFICIENTS_NOT_PARAMETERS",
    "The mass is right, and b or Fc, or both, come out at about the right value divided by the mass.",
    "The fit gives b/m and Fc/m: multiply both by m.",
).around(
    "identify",
    """
        found = _right(t, u, y)
        m = found["m"][0]
        return {k: [x / m for x in entry] if k in ("b", "Fc") else entry for k, entry in found.items()}
    """,
)
mistakes(
    "ESTIMATE_HARD_CODED",
    "The same values come back for different carts, or those of the data sheet.",
    "Everything must come from this call's t, u and y; the data sheet is only where a search starts.",
).body(
    "identify",
    """
        values = {"m": 1.5, "b": 0.6, "Fc": 0.4, "tau": 0.06, "latency": 0.08, "lag": 0.14}
        return {k: [x, 0.98 * x, 1.02 * x] for k, x in values.items()}
    """,
)
mistakes(
    "GAINS_HARD_CODED",
    "Your code returns the same gains for very different carts.",
    "Draw carts around the given estimate, roll them out, and take the gains with the least mean settling time. Where every cart counts as 3 s, as the slowest alone does, no gains are better than others, and a descent does not move. Keep nothing from an earlier call, which was about another cart.",
).body("tune", 'return {"kp": 15.2, "kd": 7.4}').program(
    "tune",
    """
        _anew = tune
        _FOUND = {}


        def tune(estimate, randomization):
            if not _FOUND:
                _FOUND.update(_anew(estimate, randomization))
            return dict(_FOUND)
    """,
)
mistakes(
    "DELAY_IGNORED",
    "Another latency in the estimate makes no difference to the gains, and they suit a cart with a shorter delay.",
    "The carts you tune on need the estimated latency, times a factor from the box. If they have it, search a wider grid.",
).around("tune", 'return _right({**estimate, "latency": [0.001, 0.001, 0.001]}, randomization)')
mistakes(
    "RANDOMIZATION_IGNORED",
    "Three other boxes make no difference to the gains.",
    "Draw each parameter between value * low and value * high of the box that is passed in, and take the mean over the draws. If you do, keep nothing from an earlier call, and try more gains.",
).around("tune", "return _right(estimate, {k: [1.0, 1.0] for k in NAMES})").around(
    "tune",
    """
        wide = {"m": 1.05, "b": 1.5, "Fc": 0.9, "tau": 1.2, "latency": 1.2}
        return _right(estimate, {k: [math.exp(-w), math.exp(w)] for k, w in wide.items()})
    """,
).around("tune", "return _right(estimate, {k: [math.exp(-w), math.exp(w)] for k, w in LOG_WIDTH.items()})")
mistakes(
    "GAINS_SWAPPED",
    "With kp and kd swapped, the gains would do well, for this question and for others.",
    "Check their order: kp multiplies the distance, and kd the speed.",
).around(
    "tune",
    """
        gains = _right(estimate, randomization)
        return {"kp": gains["kd"], "kd": gains["kp"]}
    """,
)
mistakes(
    "NO_CART_SETTLES",
    "With these gains hardly any cart drawn from the box settles: the others pass the mark by more than 0.10 m, or are not at the mark when the run ends.",
    "Are the carts drawn from the box, around the estimate? Is it the least mean over the carts (axis 0) that is taken (argmin)? Does the search cover kd/kp from 0.2 to 0.8, and is kd returned as ratio * kp? If it is a descent, start it from a grid: where every cart fails there is no slope.",
    kind="fact",
).body(
    "tune",
    """
        rng = np.random.default_rng(0)
        carts = {k: estimate[k][0] * np.exp(rng.uniform(*np.log(randomization[k]), 60)) for k in NAMES}
        around = np.array([(1, 1), (1.05, 1), (1, 1.05), (0.95, 1), (1, 0.95)]).T

        kp, kd = 3.0, 3.0
        for _ in range(12):
            kps, kds = kp * around[0], kd * around[1]
            best = rollout(kps, kds, carts, np.random.default_rng(1)).mean(axis=0).argmin()
            if best == 0:
                break
            kp, kd = float(kps[best]), float(kds[best])
        return {"kp": kp, "kd": kd}
    """,
).body(
    "tune",
    """
        rng = np.random.default_rng(0)
        box = {name: np.log(randomization[name]) for name in NAMES}
        carts = {name: estimate[name][0] * np.exp(rng.uniform(*box[name], 60)) for name in NAMES}
        kp, ratio = (x.ravel() for x in np.meshgrid(np.geomspace(2, 40, 16), np.linspace(0.2, 0.75, 12)))
        times = rollout(kp, kp * ratio, carts, np.random.default_rng(1))
        i = np.argmax(np.mean(times, axis=0))
        return {"kp": float(kp[i]), "kd": float(kp[i] * ratio[i])}
    """,
)
mistakes(
    "PROMISE_NOT_A_SHARE",
    "The threshold of the whole plan is well above 1, the largest success there is.",
    "Success is a fraction, and this threshold has no unit: 92 % is 0.92.",
    kind="fact",
).around("plan", 'return {**_right(), "threshold": 94}')
mistakes(
    "PROMISE_OF_PERFECTION",
    "The plan promises the best possible gains on every fleet, or better.",
    "Only the best possible gains have a success of 1. Promise at least 0.90 and less than 1.",
    kind="fact",
).around("plan", 'return {**_right(), "threshold": 1.0}')
mistakes(
    "EXCITATION_RESTS",
    "The force is zero for more than 40 % of the time. A cart that stands still shows hardly anything.",
    "Drive the cart for the whole time, with full force, reversed after a random 0.1 to 0.6 s.",
).around(
    "design_excitation",
    """
        u = _right(budget_s, u_max, rng)
        return np.where(np.arange(len(u)) % 500 < 30, u, 0.0)
    """,
)
mistakes(
    "EXCITATION_ENDS",
    "After the first part of the recording every command is zero: for more than 40 % of the time nothing drives the cart.",
    "Drive the cart to the end. If a loop fills the array with slices, each goes from start to start + hold: u[start:hold] is empty once start is larger than hold.",
).body(
    "design_excitation",
    """
        n = round(100 * budget_s)
        return np.where(np.arange(n) < 200, u_max, 0.0)
    """,
).body(
    "design_excitation",
    """
        u, start, side = np.zeros(round(100 * budget_s)), 0, 1.0
        while start < len(u):
            hold = int(rng.integers(10, 60))
            u[start:hold] = side * u_max
            start, side = start + hold, -side
        return u
    """,
)
mistakes(
    "INTERVAL_WITHOUT_RECORDING",
    "On average, the intervals from short and weak recordings are less than 1.5 times as wide as those from full ones.",
    "Compute each interval from this recording, by refits with one block left out, and not from a fixed width or share. If you do, refine the times in each refit, between the points of the grid.",
).around(
    "identify",
    """
        found = {k: entry[0] for k, entry in _right(t, u, y).items()}
        half = {"m": 0.0299}
        return {k: [x, x * (1 - half.get(k, 0.199)), x * (1 + half.get(k, 0.199))] for k, x in found.items()}
    """,
).around(
    "identify",
    """
        half = {"m": 0.004, "b": 0.025, "Fc": 0.03, "tau": 0.04, "latency": 0.02, "lag": 0.008}
        return {k: [e[0], e[0] * (1 - half[k]), e[0] * (1 + half[k])] for k, e in _right(t, u, y).items()}
    """,
)
mistakes(
    "FRICTIONS_SWAPPED",
    "b comes out near the value of Fc, and Fc near the value of b.",
    "b belongs to the integral of the speed, Fc to the integral of its sign: check which coefficient goes into which entry.",
).around(
    "identify",
    """
        found = _right(t, u, y)
        return {**found, "b": found["Fc"], "Fc": found["b"]}
    """,
)
mistakes(
    "VISCOUS_AS_COULOMB",
    "b comes out far too small and Fc too large, as if Coulomb friction stood for both.",
    "Give each its own column: the integral of the speed for b, the integral of its sign for Fc. If they are there, compare them with the README's.",
).around(
    "identify",
    """
        best = None
        for tau in np.arange(0.02, 0.151, 0.01):
            impulse = motor_impulse(u, tau)
            for late in np.arange(0.02, 0.201, 0.005):
                columns = [delayed(impulse, late), cumulative(np.sign(y))]
                X, v = in_blocks(np.stack(columns, axis=1)), in_blocks(y)
                k = X.shape[2]
                theta, left, *_ = np.linalg.lstsq(X.reshape(-1, k), v.reshape(-1))
                if best is None or left[0] < best[0]:
                    best = left[0], tau, late, theta
        _, tau, late, theta = best
        m = 1 / theta[0]
        found = {"m": m, "b": 0.0, "Fc": -theta[1] * m, "tau": tau, "latency": late, "lag": tau + late}
        half = {k: e[2] - e[0] for k, e in _right(t, u, y).items()}
        return {k: [float(x), float(x - half[k]), float(x + half[k])] for k, x in found.items()}
    """,
)
mistakes(
    "TIME_FROM_SHEET",
    "tau or the latency comes out as the data sheet's value for every cart that was tried.",
    "Try a fine grid of both times, tau from 0.02 to 0.15 s and latency from 0.02 to 0.20 s, fit with each pair, keep the one with the smallest residual, and refine around it.",
).around(
    "identify",
    _by_search("delayed(impulse, late), cumulative(y), cumulative(np.sign(y))").replace(
        "np.arange(0.02, 0.151, 0.01)", "[0.06]"
    ),
)
mistakes(
    "NOISE_DIFFERENTIATED",
    "The mass is as small as differentiating the measured speed makes it.",
    "Integrate the equation instead of differentiating the data: sums average noise, while differences amplify it. If you integrate already, compare the columns with the README's.",
).around(
    "identify",
    """
        found = _right(t, u, y)
        tau, late = found["tau"][0], found["latency"][0]
        force = np.gradient(delayed(motor_impulse(u, tau), late), H)
        X = np.stack([np.gradient(y, H), y, np.sign(y)], axis=1)
        theta = np.linalg.lstsq(X, force)[0]
        for name, value in zip(("m", "b", "Fc"), theta.tolist()):
            half = found[name][2] - found[name][0]
            found[name] = [value, value - half, value + half]
        return found
    """,
)
mistakes(
    "GAINS_BY_FORMULA",
    "The gains change with the mass and the viscous friction, but not with any other latency or box that was tried.",
    "Draw carts from the box that is passed in, around the estimate, roll them out, and take the gains that do best on them.",
).body(
    "tune",
    """
        m = estimate["m"][0]
        return {"kp": 9.3 * m, "kd": 4.5 * m}
    """,
)
mistakes(
    "NO_DAMPING",
    "kd is zero, or less than a twentieth of kp.",
    "Search over the ratio kd/kp too, from 0.2 to 0.8, and return kd itself: ratio * kp.",
).body(
    "tune",
    """
        rng = np.random.default_rng(2)
        carts = {k: estimate[k][0] * np.exp(rng.uniform(*np.log(randomization[k]), 60)) for k in NAMES}
        kp = np.geomspace(0.5, 40, 15)
        mean = rollout(kp, np.zeros(15), carts, np.random.default_rng(1)).mean(axis=0)
        return {"kp": float(kp[mean.argmin()]), "kd": 0.0}
    """,
)
mistakes(
    "SEARCH_ENDED_EARLY",
    "Other gains do clearly better on these carts.",
    "Are there several hundred carts, each parameter the estimate's value times a factor drawn by itself and log-uniformly from the box? Is it the mean over all carts, axis 0 of what rollout returns, that is least, 3 s for each that fails? Is the grid as wide and fine as kp in np.geomspace(2, 40, 20) and kd/kp in np.linspace(0.2, 0.8, 13)? Is its best point refined, and returned as kp and kd?",
    kind="consequence",
).around(
    "tune",
    """
        gains = _right(estimate, randomization)
        return {**gains, "kp": min(gains["kp"], 4.0)}
    """,
)
mistakes(
    "WORST_CART",
    "Where all carts can settle, your gains are about the best for the slowest one. Where with all gains some cart counts as 3 s, they are the same each time.",
    "Take the mean settling time over all carts, not the largest: .mean(axis=0). If you do, see that the carts are drawn from the box alone, around the estimate.",
).body(
    "tune",
    """
        rng = np.random.default_rng(2)
        carts = {k: estimate[k][0] * np.exp(rng.uniform(*np.log(randomization[k]), 60)) for k in NAMES}
        kp, ratio = (x.ravel() for x in np.meshgrid(np.geomspace(1.0, 40, 40), np.linspace(0.25, 0.8, 12)))
        cost = rollout(kp, kp * ratio, carts, np.random.default_rng(1)).max(axis=0)
        return {"kp": float(kp[cost.argmin()]), "kd": float((kp * ratio)[cost.argmin()])}
    """,
)
mistakes(
    "MEDIAN_CART",
    "For several questions your gains are about the best for the median of the settling times. At least once their mean is clearly later than it could be.",
    "Take the mean over all carts, with 3 s for each that fails. If you already do, search more finely, and compare gains by the mean settling time of all carts.",
    kind="consequence",
).edit(
    "tune",
    {
        "np.random.default_rng(1)).mean(axis=0)\n        return kp[mean.argmin()]": "np.random.default_rng(1))\n        mean = np.median(mean, axis=0)\n        return kp[mean.argmin()]"
    },
)
mistakes(
    "SLOW_TAIL",
    "Here and for four other questions, your gains suit the slowest carts: the mean settling time with two standard deviations added is about as small as with any gains, and the mean itself is not.",
    "Take the mean over all carts, with 3 s for each that fails, and neither a high percentile nor a spread added. If you already do, draw more carts and search more finely.",
    kind="consequence",
).edit(
    "tune",
    {
        "mean = rollout(kp, kp * ratio, carts, np.random.default_rng(1)).mean(axis=0)": "times = rollout(kp, kp * ratio, carts, np.random.default_rng(1))\n        mean = times.mean(axis=0) + 2 * times.std(axis=0)"
    },
)
mistakes(
    "KP_STAYS",
    "kp is the same number for several of the carts and boxes that were asked, and gains with a larger kp do better.",
    "Let the search go on: kp from 2 to 40, with kd/kp from 0.2 to 0.8. The motor's limit is part of rollout, and the best gains may reach it.",
    kind="fact",
).edit(
    "tune",
    {"np.geomspace(2, 40, 12)": "np.geomspace(0.5, 3.5, 8)", "kp * np.geomspace(0.8, 1.25, 5)": "[kp]"},
)
mistakes(
    "ROLLOUT_GIVEN_RATIO",
    "Here and for other questions, with kd/kp in place of kd your gains would be about the best of those with kd from 0.2 to 0.8, as if rollout were given the ratio.",
    "Give rollout the gain itself: rollout(kp, ratio * kp, carts, rng).",
    kind="consequence",
).edit("tune", {"rollout(kp, kp * ratio, carts": "rollout(kp, ratio, carts"})
mistakes(
    "BOX_WITHOUT_ESTIMATE",
    "Other masses and another latency in the estimate make no difference to the gains. For a box around the data sheet's own values they suit carts with these values, as if the box held the parameters themselves.",
    "The box holds factors: draw each parameter between value * low and value * high, with the value from the estimate.",
).edit("tune", {"estimate[name][0] * np.exp": "np.exp"})
mistakes(
    "FAILURES_LEFT_OUT",
    "With these gains more than half of the carts count as 3 s, but the soonest cart, or the mean of those that settle, is sooner than with the gains that are best for all. So it is with a mean that leaves out every cart that counts as 3 s, and by chance with gains for other carts.",
    "Take the mean over all carts, with 3 s for each that fails. If you do, look at the carts: each parameter is the estimate's value times a factor drawn from the box.",
    kind="fact",
).edit(
    "tune",
    {
        "np.random.default_rng(1)).mean(axis=0)\n        return": "np.random.default_rng(1)).min(axis=0)\n        return"
    },
    also=("SEARCH_ENDED_EARLY", "NO_CART_SETTLES"),
).edit(
    "tune",
    {
        "np.random.default_rng(1)).mean(axis=0)\n        return": "np.random.default_rng(1))\n        mean = np.ma.masked_equal(mean, 3.0).mean(axis=0).filled(3.0)\n        return"
    },
    also=("SEARCH_ENDED_EARLY", "NO_CART_SETTLES"),
)
mistakes(
    "EXCITATION_NOT_FULL",
    "The force stays below u_max. In at least one of the checks the same signal, scaled up to it, would show enough.",
    "Scale the finished signal so that its largest absolute value is u_max: the noise stays the same. Most of it should be near that: rare peaks show little.",
).around(
    "design_excitation", 'return 0.36 * np.convolve(_right(budget_s, u_max, rng), np.full(100, 0.01), "same")'
)
mistakes(
    "EXCITATION_STANDS",
    "A cart stands still for more than half of the recording: there the motor's force is below its friction. A cart at rest shows hardly anything.",
    "Use the full force in both directions most of the time. A sum of sines needs phases that keep its peak small; full force, reversed at irregular intervals, is better still.",
).body(
    "design_excitation",
    """
        t = np.arange(round(100 * budget_s)) / 100
        u = np.cos(2 * np.pi * np.outer(t, np.arange(0.1, 3.0, 0.1))).sum(axis=1)
        return u_max * u / np.abs(u).max()
    """,
)
mistakes(
    "LAG_READ",
    "The gains change with the estimate's lag, although tau and latency stay as they are.",
    "rollout takes tau and latency. lag is their sum: used for one of them, it counts the other one twice.",
).around("tune", 'return _right({**estimate, "latency": estimate["lag"]}, randomization)')
mistakes(
    "LOWS_NOT_READ",
    "The gains stay exactly as they are when the low ends of the box's ranges are moved, and change with the high ends.",
    "Draw each parameter between value * low and value * high, and take the mean over all carts.",
).around("tune", "return _right(estimate, {k: [high, high] for k, (_, high) in randomization.items()})")
mistakes(
    "WIDTH_NOT_READ",
    "The gains stay exactly as they are when the box gets narrower or wider about the same middle.",
    "Draw each parameter between value * low and value * high of the box that is passed in.",
    kind="fact",
).around(
    "tune",
    """
        middles = {k: math.sqrt(low * high) for k, (low, high) in randomization.items()}
        return _right(estimate, {k: [x / 1.5, 1.5 * x] for k, x in middles.items()})
    """,
)
mistakes(
    "KD_FOLLOWS_KP",
    "kd is the same in all answers, or follows from kp in the same way.",
    "Search over pairs: kp from 2 to 40 and kd/kp from 0.2 to 0.8. A formula of kp, mass and friction knows neither the lag nor the latency.",
).body(
    "tune",
    """
        rng = np.random.default_rng(0)
        carts = {k: estimate[k][0] * np.exp(rng.uniform(*np.log(randomization[k]), 60)) for k in NAMES}
        kp = np.geomspace(1, 40, 30)
        kd = 2 * np.sqrt(kp * estimate["m"][0]) - estimate["b"][0]
        i = rollout(kp, kd, carts, np.random.default_rng(1)).mean(axis=0).argmin()
        return {"kp": float(kp[i]), "kd": float(kd[i])}
    """,
).edit("tune", {"np.linspace(0.25, 0.7, 8)": "[0.35]", "ratio + np.linspace(-0.06, 0.06, 5)": "[0.35]"})
mistakes(
    "ESTIMATE_KEPT",
    "Asked twice in a row about one recording, your code answers the same, but something else after recordings of other carts.",
    "Keep nothing from one call to the next: start each search anew, inside the function, from what the call is given.",
    kind="fact",
).program(
    "identify",
    """
        _right = identify
        _before = {}


        def identify(t, u, y):
            found = _right(t, u, y)
            for name, entry in found.items():
                shift = 0.02 * (_before.get(name, entry[0]) - entry[0])
                found[name] = [number + shift for number in entry]
                _before[name] = found[name][0]
            return found
    """,
)
mistakes(
    "COMMAND_KEPT",
    "Asked about the same speeds with another command, your code gives the same estimate.",
    "Compute everything from the u of this call. If you keep impulses outside the function, by their tau say, later calls get those of an earlier command.",
    kind="fact",
).program(
    "identify",
    """
        _impulse = motor_impulse
        _made = {}


        def motor_impulse(u, tau):
            if (len(u), tau) not in _made:
                _made[len(u), tau] = _impulse(u, tau)
            return _made[len(u), tau]
    """,
)
mistakes("RESULT_OVERWRITTEN").program(
    "plan",
    """
        _once = plan
        _GAPS = []


        def plan():
            _GAPS.extend(_once()["gaps"])
            return {**_once(), "gaps": _GAPS}
    """,
)
mistakes(
    "PLAN_VARIES",
    "What a call returns depends on chance or on an earlier call.",
    "A plan is carried out as it stands: return the same one each time, made anew in every call.",
).program(
    "plan",
    """
        _once = plan
        _CHANCE = np.random.default_rng()


        def plan():
            return {**_once(), "threshold": _CHANCE.uniform(0.94, 0.95)}
    """,
)

# -- plan: its gaps

mistakes(
    "UNKNOWN_WORD",
    "The plan uses a word that is not in the README's list for that key.",
    "The plan is executed by a program, so take each word from the list of its own key, spelled exactly as there.",
    kind="fact",
)
mistakes(
    "TOO_FEW_GAPS",
    "The plan names too few gaps.",
    "List at least three gaps, each with all of its entries.",
    kind="fact",
)
mistakes(
    "PARAMETER_OF_ANOTHER_SOURCE",
    "It belongs to another one.",
    "The README's table says which parameters go with each source: b and Fc with friction, latency and lag with delay.",
    kind="fact",
)
mistakes(
    "ESTIMATOR_CANNOT",
    "The estimator given does not estimate this parameter.",
    "integral_least_squares is for m, b and Fc, delay_grid for tau, latency and lag, and standard_deviation for noise.",
    kind="fact",
)
mistakes(
    "METRIC_DOES_NOT_JUDGE",
    'The metric of the whole plan is not the word "success".',
    'The metric of the whole plan must be "success".',
    kind="fact",
)
mistakes(
    "PROMISE_TOO_SMALL",
    "The plan as a whole promises less than the README asks for.",
    "The threshold of the whole plan must be at least 0.90 and below 1.",
    kind="fact",
)
mistakes(
    "BOX_REVERSED",
    "An interval of the box has its ends in the wrong order, or is not an interval of positive factors.",
    "Write [low, high] with 0 < low <= high.",
    kind="fact",
)
mistakes(
    "BOX_LACKS",
    "A key is missing, or there is one too many.",
    "The box has exactly the keys m, b, Fc, tau and latency, each with [low, high].",
    kind="fact",
)
mistakes(
    "PROMISE_NOT_KEPT",
    "Even with good excitation, identification and tuning, the mean success over the fleets is below what the plan promises, or below 0.90.",
    "Here only the box and the promise come from your plan. Where the ends of the box are not the fleet's, e^-w and e^w, take these. Where they are, promise less, but at least 0.90.",
    kind="consequence",
)
mistakes(
    "NOT_FINITE",
    "One of the values is not a finite number.",
    "Look for a division by zero, a logarithm of zero, an overflow, an uninitialised array, or a start value such as inf that is never replaced.",
    kind="fact",
)
mistakes(
    "EXCITATION_ZERO",
    "Every command is zero.",
    "Print a few commands. An integer array, for example, turns forces below 1 N into zeros.",
)

# -- identify: values

mistakes(
    "VALUES_OFF",
    "In at least one recording a value is further off than the README's limit for values.",
    "Look at the values before the intervals: correct them, or make the fit scatter less from one recording to the next.",
    kind="consequence",
)
mistakes(
    "VISCOUS_MISSING",
    "b comes out near zero, or at a small part of its value.",
    "Viscous friction needs its own column, the integral of the speed over time, as `cumulative(y)` gives it. In the README's form, b is minus its coefficient times m.",
)
mistakes(
    "COULOMB_MISSING",
    "Fc comes out near zero, or at a small part of its value.",
    "Coulomb friction needs its own column, the integral of the speed's sign over time, as `cumulative(np.sign(y))` gives it. In the README's form, Fc is minus its coefficient times m.",
)
mistakes(
    "MASS_INVERTED",
    "The value returned as m is about one over the mass.",
    "In the README's form the coefficient of the impulse is 1/m: m is its reciprocal. If your fit gives m itself, take no reciprocal.",
)
mistakes(
    "FRICTION_SIGN",
    "b or Fc comes out negative for most of the recordings.",
    "Both slow the cart down: in the README's form b is minus the coefficient times m. A column that has the minus already needs no second one. If the signs are right, compare the columns with the README's.",
)
mistakes(
    "ESTIMATE_NEGATIVE",
    "m, tau or the latency comes out negative.",
    "For a negative mass look at the columns of the fit: a sign, their order, or y where u belongs. For a negative time keep the refinement within the range of the search.",
    kind="fact",
)
mistakes(
    "LAG_IGNORED",
    "tau comes out as nearly zero, as if the motor followed its command at once.",
    "Try motor_impulse(u, tau) for each tau from 0.02 to 0.15 s, and keep the one with the smallest residual. If you do, compare the columns of the fit with the README's.",
)
mistakes(
    "LAG_NOT_SUM",
    "The value of lag is not the sum of those of tau and latency.",
    "lag = tau + latency, all three in seconds. Compute its interval from the same refits: the errors of the two largely cancel in the sum.",
)
mistakes(
    "TIMES_EXCHANGED",
    "tau comes out at about the latency's value, and the latency at about tau's.",
    "tau is the time constant that motor_impulse(u, tau) takes, and the latency is what `delayed` shifts by.",
    kind="fact",
)
mistakes(
    "UNITS_NOT_SECONDS",
    "tau, the latency or the lag comes out about 1000 or 100 times too large, as it does in milliseconds or in samples of 0.01 s.",
    "tau, latency and lag are in seconds, not in milliseconds or in samples of 0.01 s.",
)
mistakes(
    "LOCAL_MINIMUM",
    "The lag, tau and latency together, is off by more than a quarter for at least half of these recordings.",
    "Try a whole grid of tau and latency, keep the best pair, and refine only around it. If you do, fit y as it was recorded, all blocks at once, compare the columns with the README's, and see that no column is kept from another recording.",
)
mistakes(
    "FORCE_SCALED",
    "The mass and both friction values are off by about the same factor.",
    "Check the unit of the force, N: do not scale u or the motor's impulse, and divide only by the coefficient 1/m.",
)
mistakes(
    "INTERVAL_WITHOUT_WIDTH",
    "The two ends of an interval are equal, or differ by a rounding error, and not in one recording alone.",
    "Refit every parameter with one block left out, the times too. A time that keeps the data sheet's value, or stays on its grid, shows no spread: search it in each refit, and between the points of the grid. If you do, let the last step be far smaller: the refits differ by less than it.",
    kind="fact",
).edit(
    "identify",
    {
        "np.linalg.solve(XX.sum(axis=0) - XX, (Xv.sum(axis=0) - Xv)[..., None])[..., 0]": "np.pad(np.linalg.solve((XX.sum(axis=0) - XX)[:, :3, :3], (Xv.sum(axis=0) - Xv)[:, :3, None])[..., 0], [(0, 0), (0, 2)])"
    },
)

# -- tune

mistakes(
    "IDENTIFY_TOO_SLOW",
    "There was no answer within the time limit.",
    "See that every loop ends. motor_impulse is slow: call it once for each tau, not once for each pair of times, and fit on a coarse grid before you refine. For the same times, a refit without one block needs only new sums, not new columns.",
    kind="fact",
)
mistakes(
    "TUNE_TOO_SLOW",
    "There was no answer within the time limit.",
    "rollout takes arrays: pass all gains of a grid and all carts at once, not one after the other. Search coarsely with few carts before you search finely with all of them.",
    kind="fact",
)
mistakes(
    "ESTIMATE_IGNORED",
    "The gains change with the box, but other masses and another latency in the estimate make no difference to them.",
    "The box holds factors: draw each parameter between value * low and value * high, with the value from the estimate that is passed in.",
)
mistakes(
    "KD_IS_RATIO",
    "With kp times kd in place of kd the gains would do well, as if the ratio kd/kp were returned as kd.",
    "Return the gain itself: kd = ratio * kp.",
)
mistakes(
    "ENDS_READ",
    "The gains change with the ends of the estimate's intervals, although the values stay as they are.",
    "Each entry is [value, low, high]: draw the carts around the value, entry[0]. How much they vary is in the box.",
)
mistakes(
    "ONE_DRAW_FOR_ALL",
    "Here and for four other questions, your gains suit carts that are all large or all small at once better than carts drawn one parameter at a time, as if one random number set all five parameters of a cart.",
    "Draw a number of its own for each parameter: a generator that starts anew from the same seed gives the same numbers again. If you already do, search more finely, and compare gains by the mean settling time of all carts.",
    kind="consequence",
).body(
    "tune",
    """
        rng = np.random.default_rng(2)
        box = {k: np.log(randomization[k]) for k in NAMES}
        carts = {k: estimate[k][0] * np.exp(np.random.default_rng(0).uniform(*box[k], 300)) for k in NAMES}
        kp, ratio = (x.ravel() for x in np.meshgrid(np.geomspace(2, 40, 20), np.linspace(0.2, 0.8, 13)))
        mean = rollout(kp, kp * ratio, carts, np.random.default_rng(1)).mean(axis=0)
        kp, ratio = kp[mean.argmin()], ratio[mean.argmin()]
        kp, ratio = (x.ravel() for x in np.meshgrid(kp * np.geomspace(0.85, 1.18, 5), ratio + np.linspace(-0.05, 0.05, 5)))
        mean = rollout(kp, kp * ratio, carts, np.random.default_rng(1)).mean(axis=0)
        return {"kp": float(kp[mean.argmin()]), "kd": float((kp * ratio)[mean.argmin()])}
    """,
)
mistakes(
    "BOX_ENDS_ALONE",
    "Here and for four other questions, your gains suit carts whose parameters all lie at an end of their range better than carts drawn from all of it.",
    "Draw each factor anywhere between low and high: np.exp(rng.uniform(np.log(low), np.log(high), n)). If you already do, search more finely, and compare gains by the mean settling time of all carts.",
    kind="consequence",
).edit(
    "tune",
    {"(rng.permutation(200) + 0.5) / 200": "rng.integers(0, 2, 200)"},
    also=("SEARCH_ENDED_EARLY", "FAILURES_LEFT_OUT"),
)
mistakes(
    "FACTORS_DIVIDE",
    "Here and for four other questions, your gains suit carts whose parameters are the estimate's values divided by factors from the box, and not those with the products.",
    "Multiply: value * factor. If you already do, search more finely, and compare gains by the mean settling time of all carts.",
    kind="consequence",
).edit(
    "tune",
    {"estimate[name][0] * np.exp": "estimate[name][0] / np.exp"},
    also=("NO_CART_SETTLES", "FAILURES_LEFT_OUT", "SEARCH_ENDED_EARLY"),
)
mistakes(
    "FACTORS_ADDED",
    "Here and for four other questions, your gains suit carts whose parameters are the estimate's values times 1 + factor, and not those of the box.",
    "The box has factors, not changes: value * factor. If that is what you take, search more finely.",
    kind="consequence",
).edit("tune", {"np.exp(low + share * (high - low))": "(1 + np.exp(low + share * (high - low)))"})
mistakes(
    "LAG_FOR_LATENCY",
    "Here and for four other questions, your gains suit carts whose latency is tau + latency better than those of the box.",
    "rollout takes tau and latency: give it each as it is, times its factor. If you already do, search more finely, and compare gains by the mean settling time of all carts.",
    kind="consequence",
).edit(
    "tune", {"few = {": 'carts["latency"] *= 1 + estimate["tau"][0] / estimate["latency"][0]\n    few = {'}
)
mistakes(
    "TUNE_RAISES",
    "For at least one of four other questions tune raises an exception: heavier, lighter or later carts, or another box.",
    "Call it with such an estimate yourself, and read the last line. rollout returns shape (carts, gains): the mean over axis 0 is one number for each gain, and its argmin says which gains.",
    kind="fact",
).body(
    "tune",
    """
        rng = np.random.default_rng(6)
        carts = {k: estimate[k][0] * np.exp(rng.uniform(*np.log(randomization[k]), 300)) for k in NAMES}
        kp, ratio = (x.ravel() for x in np.meshgrid(np.geomspace(2, 40, 10), np.linspace(0.2, 0.8, 9)))
        mean = rollout(kp, kp * ratio, carts, np.random.default_rng(1)).mean(axis=1)
        return {"kp": float(kp[mean.argmin()]), "kd": float((kp * ratio)[mean.argmin()])}
    """,
)
mistakes(
    "RANGE_NOT_READ",
    "The gains stay exactly as they are when the box's range of one parameter (m or latency) is shifted by a factor of 1.8.",
    "Draw every parameter from its own range of the box, around the estimate's value. If you do, try more gains.",
)
mistakes(
    "GAINS_NEGATIVE",
    "A gain is negative. A negative kp pushes the cart away from its mark, and a negative kd speeds it up.",
    "Search only among positive gains; a logarithmic grid contains no others.",
    kind="fact",
)


model = kit.sibling(__file__, "sim_to_real")


NAMES = model.NAMES


@mistakes.more
def hypotheses():
    """Task, codes of what is wrong, and function of each, those with one mistake first."""
    for task, family, terms in (
        ("plan", _plan, _PLAN),
        ("design_excitation", _excitation, _EXCITATION),
        ("identify", _identify, _IDENTIFY),
        ("tune", _tune, _TUNE),
    ):
        for term, forms in terms.items():
            for code, form in forms:
                yield task, (code,), family(**{term: form})
    firsts = {term: dict(reversed(forms)).items() for term, forms in _PLAN.items()}
    for one, other in itertools.combinations(_PLAN, 2):
        for (code, form), (second, another) in itertools.product(firsts[one], firsts[other]):
            if code != second:
                yield "plan", (code, second), _plan(**{one: form, other: another})


def _plan(
    box=lambda w: [math.exp(-w), math.exp(w)],
    left_out=(),
    seconds=20.0,
    promise=0.94,
    metric="success",
    **gap,
):
    """``gap``: what is changed of the plan's second gap; ``gaps``: which of them are kept."""
    kept = gap.pop("gaps", slice(None))
    changed = gap.pop("gap", {})

    def plan():
        found = model.plan()
        found["gaps"][1].update(changed)
        return {
            **found,
            "gaps": found["gaps"][kept],
            "excitation_budget_s": seconds,
            "randomization": {k: box(w) for k, w in model.LOG_WIDTH.items() if k not in left_out},
            "metric": metric,
            "threshold": promise,
        }

    return plan


def _gap(parameter, source, estimator, excitation="prbs", **rest):
    return {
        "parameter": parameter,
        "source": source,
        "estimator": estimator,
        "excitation": excitation,
        **rest,
    }


_LEAST = "integral_least_squares"


_PLAN = {
    "box": (
        ("BOX_TOO_WIDE", lambda w: [math.exp(-2.5 * w), math.exp(2.5 * w)]),
        ("BOX_TWICE_AS_WIDE", lambda w: [math.exp(-2 * w), math.exp(2 * w)]),
        ("BOX_TOO_WIDE", lambda w: [0.2, 5.0]),
        ("BOX_TOO_NARROW", lambda w: [1.0, 1.0]),
        ("BOX_FULL_WIDTH", lambda w: [math.exp(-w / 2), math.exp(w / 2)]),
        ("BOX_ONE_SIDED", lambda w: [1.0, math.exp(w)]),
        ("BOX_ONE_SIDED", lambda w: [math.exp(-w), 1.0]),
        ("BOX_HALF_LINEAR", lambda w: [math.exp(-w), 1 + w]),
        ("BOX_TOO_NARROW", lambda w: [0.9, 1.1]),
        ("BOX_IS_LINEAR", lambda w: [1 - w, 1 + w]),
        ("BOX_IN_LOGARITHMS", lambda w: [-w, w]),
        ("BOX_REVERSED", lambda w: [math.exp(w), math.exp(-w)]),
        ("BOX_REVERSED", lambda w: [0.0, math.exp(w)]),
    ),
    "left_out": (("BOX_LACKS", ("latency",)), ("BOX_LACKS", ("tau", "latency"))),
    "seconds": (
        ("BUDGET_EXCEEDED", 60.0),
        ("BUDGET_EXCEEDED", 0.0),
        ("BUDGET_TOO_SHORT", 0.5),
    ),
    "promise": (
        ("PROMISE_TOO_SMALL", 0.5),
        ("PROMISE_NOT_A_SHARE", 94.0),
        ("PROMISE_OF_PERFECTION", 1.0),
    ),
    "metric": (("METRIC_DOES_NOT_JUDGE", "relative_error"), ("METRIC_DOES_NOT_JUDGE", "settling time")),
    "gaps": (("TOO_FEW_GAPS", slice(2)), ("TOO_FEW_GAPS", slice(0))),
    "gap": (
        ("UNKNOWN_WORD", {"excitation": "white noise"}),
        ("UNKNOWN_WORD", {"unit": "percent"}),
        ("UNKNOWN_WORD", {"parameter": "viscous friction"}),
        ("SOURCE_NOT_HERE", _gap("play", "gear_backlash", "standard_deviation")),
        ("PARAMETER_OF_ANOTHER_SOURCE", _gap("m", "friction", _LEAST, threshold=3.0)),
        ("PARAMETER_OF_ANOTHER_SOURCE", _gap("tau", "delay", "delay_grid")),
        ("ESTIMATOR_CANNOT", _gap("b", "friction", "delay_grid")),
        ("ESTIMATOR_CANNOT", _gap("lag", "delay", _LEAST)),
        ("EXCITATION_CANNOT_SHOW", _gap("Fc", "friction", _LEAST, "rest")),
        ("EXCITATION_CANNOT_SHOW", _gap("lag", "delay", "delay_grid", "constant")),
        ("EXCITATION_CANNOT_SHOW", _gap("noise", "sensor_noise", "standard_deviation", "prbs")),
        ("PROMISES_TOO_MUCH", _gap("b", "friction", _LEAST, threshold=0.1, unit="%")),
        ("PROMISES_TOO_MUCH", _gap("b", "friction", _LEAST, threshold=0.05, unit="%")),
        ("PROMISES_TOO_LITTLE", _gap("b", "friction", _LEAST, threshold=50.0, unit="%")),
        ("PROMISES_TOO_LITTLE", _gap("b", "friction", _LEAST, threshold=5.0, unit="1")),
    ),
}


def _excitation(count=lambda s: round(100 * s), force=lambda u_max: u_max, wave=None, active=lambda u: u):
    def design_excitation(budget_s, u_max, rng):
        n = count(budget_s)
        t = 0.01 * np.arange(n)
        signs = np.repeat(rng.choice([-1.0, 1.0], n), rng.integers(10, 60, n))[:n]
        return active(force(u_max) * (signs if wave is None else wave(t, rng)))

    return design_excitation


def _first(seconds):
    def active(u):
        return np.where(np.arange(len(u)) < 100 * seconds, u, 0.0)

    return active


_EXCITATION = {
    "count": (
        ("WRONG_LENGTH", lambda s: int(100 * s)),
        ("WRONG_LENGTH", lambda s: 2000),
        ("WRONG_LENGTH", lambda s: round(1000 * s)),
        ("WRONG_LENGTH", lambda s: round(100 * s) + 1),
    ),
    "force": (
        ("EXCITATION_SATURATES", lambda u_max: 3.0),
        ("EXCITATION_SATURATES", lambda u_max: 2 * u_max),
        ("EXCITATION_TOO_WEAK", lambda u_max: 0.1 * u_max),
        ("EXCITATION_TOO_WEAK", lambda u_max: 0.25 * u_max),
    ),
    "wave": (
        ("EXCITATION_TOO_SLOW", lambda t, rng: np.sin(2 * np.pi * 0.05 * t)),
        ("EXCITATION_TOO_FAST", lambda t, rng: np.sin(2 * np.pi * 8 * t)),
        ("EXCITATION_TOO_FAST", lambda t, rng: rng.uniform(-1, 1, len(t))),
        ("EXCITATION_TOO_FAST", lambda t, rng: rng.choice([-1.0, 1.0], len(t))),
        ("EXCITATION_CONSTANT", lambda t, rng: np.ones(len(t))),
        ("EXCITATION_ENDS", lambda t, rng: np.where(t < 2.0, 1.0, 0.0)),
        ("EXCITATION_ZERO", lambda t, rng: np.zeros(len(t))),
    ),
    "active": (
        ("EXCITATION_ENDS", _first(2.0)),
        ("EXCITATION_RESTS", lambda u: np.where(np.arange(len(u)) % 500 < 30, u, 0.0)),
    ),
}


def _identify(read=lambda t, u, y: (t, u, y), told=lambda found: found):
    """``read``: what the fit is given; ``told``: what is made of its six entries [value, low, high]."""

    def identify(t, u, y):
        return told(model.identify(*read(t, u, y)))

    return identify


def _values(change):
    """Entries with other values, each as wide as before."""

    def told(found):
        values = change({k: entry[0] for k, entry in found.items()})
        return {k: [values[k] + x - found[k][0] for x in found[k]] for k in found}

    return told


def _widths(change):
    def told(found):
        return {k: [v, v - change(k, v, h - v), v + change(k, v, h - v)] for k, (v, _, h) in found.items()}

    return told


_FIXED = {"m": 0.029, "b": 0.19, "Fc": 0.19, "tau": 0.19, "latency": 0.19, "lag": 0.19}


_SHEET = {"m": 1.5, "b": 0.6, "Fc": 0.4, "tau": 0.06, "latency": 0.08, "lag": 0.14}


_IDENTIFY = {
    "read": (
        ("FORCE_SCALED", lambda t, u, y: (t, u / 3.0, y)),
        ("FORCE_SCALED", lambda t, u, y: (t, 2.0 * u, y)),
    ),
    "told": (
        ("MASS_INVERTED", _values(lambda v: {**v, "m": 1 / v["m"]})),
        (
            "COEFFICIENTS_NOT_PARAMETERS",
            _values(lambda v: {**v, "b": v["b"] / v["m"], "Fc": v["Fc"] / v["m"]}),
        ),
        ("FRICTION_SIGN", _values(lambda v: {**v, "b": -v["b"], "Fc": -v["Fc"]})),
        ("FRICTIONS_SWAPPED", _values(lambda v: {**v, "b": v["Fc"], "Fc": v["b"]})),
        ("VISCOUS_MISSING", _values(lambda v: {**v, "b": 1e-3})),
        ("COULOMB_MISSING", _values(lambda v: {**v, "Fc": 1e-3 * v["m"]})),
        (
            "UNITS_NOT_SECONDS",
            _values(lambda v: {**v, **{k: 1000 * v[k] for k in ("tau", "latency", "lag")}}),
        ),
        ("UNITS_NOT_SECONDS", _values(lambda v: {**v, **{k: 100 * v[k] for k in ("tau", "latency", "lag")}})),
        ("LAG_NOT_SUM", _values(lambda v: {**v, "lag": v["tau"]})),
        ("LAG_NOT_SUM", _values(lambda v: {**v, "lag": v["latency"]})),
        ("LAG_NOT_SUM", _values(lambda v: {**v, "lag": v["latency"] - v["tau"]})),
        ("ESTIMATE_HARD_CODED", _values(lambda v: _SHEET)),
        ("TIME_FROM_SHEET", _values(lambda v: {**v, "tau": 0.06, "lag": 0.06 + v["latency"]})),
        ("PARAMETER_FIXED", _values(lambda v: {**v, "latency": 0.1, "lag": v["tau"] + 0.1})),
        ("PARAMETER_FIXED", _values(lambda v: {**v, "Fc": 0.3})),
        ("INTERVAL_REVERSED", lambda found: {k: [v, h, low] for k, (v, low, h) in found.items()}),
        ("INTERVAL_REVERSED", lambda found: {k: [v, low - v, h - v] for k, (v, low, h) in found.items()}),
        ("INTERVAL_WITHOUT_WIDTH", _widths(lambda k, v, w: 0.0)),
        ("INTERVAL_OVERCONFIDENT", _widths(lambda k, v, w: w / 10)),
        ("INTERVAL_PLAIN_SPREAD", _widths(lambda k, v, w: w / 19)),
        ("INTERVAL_WITHOUT_RECORDING", _widths(lambda k, v, w: _FIXED[k] * v)),
        ("INTERVAL_USELESS", _widths(lambda k, v, w: 20 * w)),
    ),
}


def _tune(read=lambda estimate, box: (estimate, box), told=lambda gains, estimate: gains):
    """``read``: what the search is asked about; ``told``: what is made of its gains."""

    def tune(estimate, randomization):
        return told(model.tune(*read(estimate, randomization)), estimate)

    return tune


def _without(name):
    return lambda estimate, box: ({**estimate, name: [0.001] * 3}, box)


def _one(box):
    return {k: [1.0, 1.0] for k in box}


_TUNE = {
    "read": (
        ("RANDOMIZATION_IGNORED", lambda estimate, box: (estimate, _one(box))),
        ("RANDOMIZATION_IGNORED", lambda estimate, box: (estimate, {k: [0.7, 1.4] for k in box})),
        ("ESTIMATE_IGNORED", lambda estimate, box: ({k: [v] * 3 for k, v in _SHEET.items()}, box)),
        ("BOX_WITHOUT_ESTIMATE", lambda estimate, box: (dict.fromkeys(estimate, [1.0] * 3), box)),
        ("DELAY_IGNORED", _without("latency")),
    ),
    "told": (
        ("GAINS_SWAPPED", lambda gains, estimate: {"kp": gains["kd"], "kd": gains["kp"]}),
        ("NO_DAMPING", lambda gains, estimate: {**gains, "kd": 0.0}),
        ("GAINS_NEGATIVE", lambda gains, estimate: {k: -v for k, v in gains.items()}),
        ("GAINS_HARD_CODED", lambda gains, estimate: {"kp": 10.0, "kd": 7.0}),
        (
            "GAINS_BY_FORMULA",
            lambda gains, estimate: {"kp": 9.3 * estimate["m"][0], "kd": 4.5 * estimate["m"][0]},
        ),
        ("SEARCH_ENDED_EARLY", lambda gains, estimate: {k: 0.6 * v for k, v in gains.items()}),
        (
            "SEARCH_ENDED_EARLY",
            lambda gains, estimate: {"kp": min(gains["kp"], 3.0), "kd": min(gains["kd"], 2.0)},
        ),
    ),
}
