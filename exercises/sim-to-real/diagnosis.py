"""The mistakes that the checks of ``sim-to-real`` recognise, in words.

Each code says what the submission looks like and what to change. ``probes.py`` finds which one it is.
"""

from __future__ import annotations

from course.grading.kit import Diagnosis

#: code: (what it looks like, what to change)
WORDS: dict[str, tuple[str, str]] = {
    # -- plan: its gaps
    "UNKNOWN_WORD": (
        "It uses a word that is in none of the README's lists.",
        "The plan is executed by a program: take each word from the README's table, spelled as there.",
    ),
    "TOO_FEW_GAPS": (
        "It names fewer gaps than asked.",
        "List at least three gaps, each with everything that belongs to it.",
    ),
    "TOO_FEW_SOURCES": (
        "Its gaps share one or two sources.",
        "Look at the table of what the gap is made of: friction, actuator, delay, sensors, surroundings. "
        "Take at least three of them.",
    ),
    "SOURCE_NOT_HERE": (
        "It spends bench time on gear backlash, and this cart is driven without gears.",
        "A gap counts only where it exists. Read what the cart is made of, and take its own sources.",
    ),
    "PARAMETER_OF_ANOTHER_SOURCE": (
        "It names a parameter that does not come from the source beside it.",
        "The README's table says which parameters each source has: friction shows in b and Fc, a delay in "
        "latency and in the lag.",
    ),
    "ESTIMATOR_CANNOT": (
        "The estimator named does not estimate that parameter.",
        "Forces come out of integral_least_squares, times out of delay_grid, noise out of "
        "standard_deviation.",
    ),
    "BUDGET_EXCEEDED": (
        "It takes more bench time than there is.",
        "excitation_budget_s is more than nothing and at most what the README says the bench is free for.",
    ),
    "BUDGET_TOO_SHORT": (
        "The excitation is right, but it is over before it has shown the parameter.",
        "The bench is yours for longer: raise excitation_budget_s.",
    ),
    "EXCITATION_CANNOT_SHOW": (
        "The excitation named does not make the parameter visible, however long it is recorded.",
        "Ask what in the recording would differ if the parameter were larger. A steady force shows no "
        "delay, a cart at rest shows no friction, one that moves drowns the sensor's own noise.",
    ),
    "PROMISES_TOO_MUCH": (
        "No estimator could reach that threshold with this excitation in this time.",
        "Compare with what your own identify reports as interval for such a recording, and promise a bit "
        "less.",
    ),
    "PROMISES_TOO_LITTLE": (
        "The threshold would be met by a measurement too coarse to be of use.",
        "The README says how exactly each parameter is needed; a threshold above that decides nothing. "
        "Check the unit too: a share of 0.03 is 3 %.",
    ),
    "METRIC_DOES_NOT_JUDGE": (
        "The plan as a whole is not judged by what the carts achieve.",
        'The metric of the whole plan is "success".',
    ),
    "PROMISE_TOO_SMALL": (
        "The plan as a whole promises less than the README asks for.",
        "The threshold of the whole plan is 0.90 or more and below 1.",
    ),
    "PROMISE_NOT_A_SHARE": (
        "The promise of the whole plan is given in per cent.",
        "Success is a share, and there is no unit beside this threshold: 92 % is 0.92.",
    ),
    "PROMISE_OF_PERFECTION": (
        "The plan promises that its gains are the best there are on every fleet, or better than those.",
        "Success is 1 only for the best of all gains. Promise 0.90 or more and below 1.",
    ),
    # -- plan: the box
    "BOX_TOO_WIDE": (
        "The box is much wider than the fleet. Gains that must serve carts that do not exist serve the "
        "real ones badly.",
        "Make the box as wide as the fleet's spread, from e^-w to e^w for a half-width w, and no wider.",
    ),
    "BOX_TOO_NARROW": (
        "Part of the fleet lies outside the box, so the gains are tuned for a share of the carts only.",
        "Make the box as wide as the fleet's spread: from e^-w to e^w for a half-width w. One measured cart "
        "does not say what its neighbours are.",
    ),
    "BOX_IS_LINEAR": (
        "The box runs from 1 - w to 1 + w: the half-width is read as a share.",
        "The fleet's spread is given for the logarithm: the factors run from e^-w to e^w, which is not "
        "symmetric about 1.",
    ),
    "BOX_IN_LOGARITHMS": (
        "The box holds logarithms, -w and w.",
        "randomization multiplies the estimate: take the exponential of both ends.",
    ),
    "BOX_NOT_FACTORS": (
        "The box holds the values of the parameters, in their own units.",
        "Give factors on the estimate, near 1. What is estimated is not known when the plan is written.",
    ),
    "BOX_REVERSED": (
        "An interval of the box ends before it begins, or is no interval of positive factors.",
        "Write [low, high] with 0 < low <= high.",
    ),
    "BOX_LACKS": (
        "The box leaves a parameter out or has one too many.",
        "It has exactly the keys m, b, Fc, tau and latency, each [low, high].",
    ),
    "PROMISE_NOT_KEPT": (
        "Executed with sound excitation, identification and tuning, the fleet settles later than the plan "
        "promises.",
        "Only the box is the plan's own here: compare its width with the fleet's, parameter by parameter, "
        "and promise what it can keep.",
    ),
    # -- design_excitation
    "WRONG_LENGTH": (
        "The number of commands is not the duration times the rate.",
        "There is one command each 0.01 s: round(100 * budget_s) of them, for any budget_s.",
    ),
    "NOT_FINITE": (
        "There is something in it that is no finite number.",
        "Look for a division by zero, a logarithm of zero or an uninitialised array.",
    ),
    "EXCITATION_SATURATES": (
        "It commands more force than the bench gives. The amplifier would cut it off, and the recording "
        "would show another command than the one written down.",
        "Scale the finished signal so that its largest modulus is u_max, whatever u_max is.",
    ),
    "EXCITATION_CONSTANT": (
        "The force does not change, or changes once. Then a later start looks like an earlier one, and "
        "friction like a weaker motor.",
        "Reverse the force many times, at irregular intervals.",
    ),
    "EXCITATION_TOO_WEAK": (
        "The force hardly exceeds Coulomb friction: the cart stands still most of the time, and a cart at "
        "rest tells nothing.",
        "Use all of u_max; noise stays the same, so everything else is seen better.",
    ),
    "EXCITATION_TOO_SLOW": (
        "It changes so slowly that the speed follows as if there were neither mass nor lag.",
        "Put changes into it that are as quick as what you want to see: several within a second, some "
        "slower ones for the friction.",
    ),
    "EXCITATION_TOO_FAST": (
        "It changes so fast that the motor's lag and the mass average it away: the cart only trembles.",
        "Hold each command long enough for the cart to pick up speed: some tenths of a second.",
    ),
    "EXCITATION_BLIND": (
        "Some parameter stays in the dark: another one could make up for it in the recording.",
        "Mix quick changes, which show mass and lag, with longer pushes at full force either way, which "
        "show the two frictions at different speeds.",
    ),
    # -- identify: values
    "VALUES_OFF": (
        "The values themselves are too far off: what misses the truth is not the intervals' fault.",
        "Mend the values first; the checks of them say which.",
    ),
    "TIME_FROM_SHEET": (
        "tau or the latency is the data sheet's, whatever the cart.",
        "The sheet's times are where a search starts: try a grid of both, and keep what leaves the least.",
    ),
    "FRICTIONS_SWAPPED": (
        "b and Fc are exchanged.",
        "b goes with the integral of the speed, Fc with the integral of its sign.",
    ),
    "VISCOUS_MISSING": (
        "Viscous friction is missing or far too small.",
        "Give it a column of its own, the integral of the speed; b is minus its coefficient times m.",
    ),
    "COULOMB_MISSING": (
        "Coulomb friction is missing or far too small.",
        "Give it a column of its own, the integral of the speed's sign; Fc is minus its coefficient times m.",
    ),
    "ESTIMATE_HARD_CODED": (
        "It returns the same values for different carts.",
        "Everything must come from t, u and y; the data sheet is where a search starts, not where it ends.",
    ),
    "MASS_INVERTED": (
        "What it calls m is one over the mass.",
        "The coefficient of the impulse is 1/m: take its reciprocal.",
    ),
    "COEFFICIENTS_NOT_PARAMETERS": (
        "The frictions are still divided by the mass.",
        "The fit gives b/m and Fc/m: multiply both by m.",
    ),
    "FRICTION_SIGN": (
        "The frictions come out with the wrong sign.",
        "Both slow the cart: in v = impulse/m - b/m * ... they are subtracted, so b is minus the coefficient "
        "times m.",
    ),
    "COULOMB_AS_VISCOUS": (
        "Coulomb friction is missing or far too small, and viscous friction too large: one plays the part "
        "of both.",
        "Give each a column of its own: the integral of the speed for b, the integral of its sign for Fc.",
    ),
    "VISCOUS_AS_COULOMB": (
        "Viscous friction is missing or far too small, and Coulomb friction too large.",
        "Give each a column of its own: the integral of the speed for b, the integral of its sign for Fc.",
    ),
    "LATENCY_IGNORED": (
        "It behaves as if commands arrived at once.",
        "Search over the latency too: shift the impulse by each trial value with `delayed`, fit, and keep "
        "the one that leaves least.",
    ),
    "LAG_IGNORED": (
        "It behaves as if the motor followed its command at once.",
        "Search over tau as well as over the latency: motor_impulse(u, tau) for each trial value.",
    ),
    "LAG_NOT_SUM": (
        "lag is not the sum of tau and latency.",
        "lag = tau + latency. Take its interval from the same replicates: the errors of the two nearly "
        "cancel in the sum.",
    ),
    "UNITS_NOT_SECONDS": (
        "The times are not in seconds.",
        "tau, latency and lag are in s, neither in ms nor in samples of 0.01 s.",
    ),
    "LOCAL_MINIMUM": (
        "The delay it ends at is far from the true one: a search that goes downhill from one guess got "
        "stuck in a valley of its own.",
        "Try a whole grid of delays first, keep the best, and refine only from there.",
    ),
    "NOISE_DIFFERENTIATED": (
        "The mass is as much too small as differentiating the measured speed makes it: noise in the "
        "acceleration passes for motion.",
        "Integrate the equation instead of differentiating the data: sums average noise, differences "
        "amplify it.",
    ),
    # -- identify: intervals
    "INTERVAL_REVERSED": (
        "An interval does not contain its own value, has no width, or ends before it begins.",
        "Each entry is [value, low, high] with low <= value <= high, in the parameter's own unit: bounds, "
        "not widths.",
    ),
    "INTERVAL_OVERCONFIDENT": (
        "The truth lies outside twice the interval, again and again.",
        "The residuals of neighbouring samples hang together, because integrals add noise up, and an "
        "uncertain delay makes everything else uncertain. Leave out one block after the other and refit all "
        "parameters, times too. Fits that share all blocks but one are alike, so their plain spread is far "
        "too small: the standard error is sqrt((n-1)/n * sum((each - mean)**2)), with its factor n - 1.",
    ),
    "INTERVAL_WITHOUT_RECORDING": (
        "Their widths do not follow from what the recording tells.",
        "A short or weak recording tells less and needs wider intervals, a good one allows narrow ones. "
        "Compute them from the spread of refits to parts of this very recording.",
    ),
    "INTERVAL_USELESS": (
        "The interval is so wide that it would be true of almost any cart.",
        "An interval must say what the recording tells. Compute it from the spread of refits, and remember "
        "that a jackknife's spread is already that of the whole recording.",
    ),
    # -- tune
    "IDENTIFY_TOO_SLOW": (
        "There was no answer when the time was up.",
        "motor_impulse is the slow part: call it once for each tau, not once for each pair of times, and fit "
        "on a coarse grid before you refine. Refits without a block need no new columns, only other sums.",
    ),
    "TUNE_TOO_SLOW": (
        "There was no answer when the time was up.",
        "rollout takes arrays: give it all gains of a grid and all carts at once, not one after the other, "
        "and search coarsely on few carts before finely on all.",
    ),
    "GAINS_HARD_CODED": (
        "It returns the same gains for carts that differ a lot.",
        "Draw carts about the given estimate, roll them out, and take the gains that do best on them.",
    ),
    "DELAY_IGNORED": (
        "The gains do not change when the latency does. What was tuned without a delay overshoots with one.",
        "Put the estimated latency into the carts you tune on, spread like everything else.",
    ),
    "RANDOMIZATION_IGNORED": (
        "The gains do not change when the box does: they are tuned for one cart, or for a box of its own.",
        "Draw each parameter between value * low and value * high of the box that is passed in, and take "
        "the mean over the draws.",
    ),
    "NO_DAMPING": (
        "kd is zero, or next to nothing beside kp: nothing brakes the cart before its mark.",
        "Search over the ratio kd/kp as well, from 0.25 to 0.7 say.",
    ),
    "GAINS_BY_FORMULA": (
        "The gains follow the mass, and neither the latency nor the box: no rollout is behind them.",
        "Draw carts from the box that is passed in, about the estimate, roll them out, and take the gains "
        "that do best on them.",
    ),
    "GAINS_SWAPPED": (
        "With kp and kd exchanged it would do well.",
        "kp multiplies the distance, kd the speed.",
    ),
    "GAINS_NEGATIVE": (
        "A gain is negative, so the cart is pushed away from its mark.",
        "Search among positive gains only; a logarithmic grid has no others.",
    ),
    "SEARCH_ENDED_EARLY": (
        "Other gains do clearly better, on average, on the very carts it was asked about: the search stopped "
        "in a local minimum, at its edge, or between coarse points, or it looked for something else than the "
        "mean.",
        "Take the mean settling time over the carts. Search on a grid first, over kp from 2 to 40 and the "
        "ratio kd/kp from 0.25 to 0.7, and refine around the best; use the same noise for all gains, and "
        "some hundred carts.",
    ),
}


def named(code: str) -> Diagnosis:
    """The diagnosis of that code."""
    looks_like, advice = WORDS[code]
    return Diagnosis(code, looks_like, advice)
