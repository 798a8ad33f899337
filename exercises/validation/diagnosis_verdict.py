"""The mistakes that the checks of ``validate`` recognise, in words; see ``diagnosis.py``."""

from __future__ import annotations

#: code: (what it looks like, what to change)
WORDS: dict[str, tuple[str, str]] = {
    "CALIBRATION_RUNS_SCORED": (
        "It scores runs that the simulation was calibrated on, which it fits by construction.",
        "Leave out every run whose id is in calibrated_on before you compute anything.",
    ),
    "NOTHING_LEFT": (
        "It gives a verdict, or numbers, although there is nothing to judge by, or one run alone.",
        "With no run left the only reason is calibration_data and all numbers are None. With a single run "
        "the numbers stand, intervals is None, and the only reason is single_run.",
    ),
    "MATCHED_BY_POSITION": (
        "It pairs runs by their place in the list.",
        "Pair them by id: the two lists may have other orders and other runs.",
    ),
    "LAG_SIGN": (
        "The lag has the opposite sign.",
        "It is positive where the simulation is late: where sim(t + lag) looks like real(t).",
    ),
    "LAG_WHOLE_SAMPLES": (
        "The lag is a whole number of samples.",
        "The best shift lies between two samples. Lay a parabola through the misfit at the best whole "
        "shift and its two neighbours, or interpolate.",
    ),
    "LAG_IN_SAMPLES": (
        "The lag is counted in samples.",
        "Multiply by the time between samples: lag_s is in seconds.",
    ),
    "LAG_NOT_BEST": (
        "Another shift fits the samples of all runs better.",
        "Shift by shift, in seconds, add up the squares of sim(t + s) - real(t) over the samples of all runs "
        "and divide by how many there were. Steps may differ from run to run; subtract, and do not multiply.",
    ),
    "LAG_AT_THE_END": (
        "It is as large as a lag can be, or larger: the search ends where it runs out of shifts, not where "
        "the fit is best.",
        "Compare mean squares, not sums: fewer samples overlap at a larger shift. And if you multiply "
        "instead of subtracting, take the means off first.",
    ),
    "LAG_MEAN_OF_RUNS": (
        "It is an average of one lag for each run.",
        "Look for one shift that all runs share: add up the squares of all runs and their counts, shift by "
        "shift, and take the shift with the least mean square.",
    ),
    "LAG_OF_PARTS": (
        "The lag is right and the other intervals are: with a run left out the lag is not found as well.",
        "Search for the best shift anew for every set of runs, as finely as for all of them.",
    ),
    "JACKKNIFE_FACTOR": (
        "It takes the spread of the values with one run left out for the standard error.",
        "Those values hardly differ, for they share nearly all of their runs, so the sum of their squared "
        "deviations has to be multiplied by (n - 1)/n, not divided by n or n - 1: standard error = "
        "sqrt((n - 1)/n * sum).",
    ),
    "NOT_STUDENTS_T": (
        "The interval reaches another number of standard errors to each side than it should.",
        "Multiply by T95[n - 2], the t of n - 1 degrees of freedom for n runs: the error itself is known "
        "from few runs, and the fewer they are, the further the interval must reach.",
    ),
    "SPREAD_OF_RUNS": (
        "The standard error is made of the values of single runs.",
        "Leave one run out at a time, and pool the samples of all others: the runs differ in length, and "
        "what is wanted is the error of the pooled number.",
    ),
    "SAMPLES_COUNTED": (
        "The standard error is that of so many independent samples, and they are not: neighbours resemble "
        "each other, and a run is off as a whole.",
        "Count runs, not samples: leave one run out at a time.",
    ),
    "ZERO_WIDTH": (
        "The interval is a single point.",
        "It reaches from the number minus t standard errors to the number plus t standard errors.",
    ),
    "POINT_ESTIMATE_JUDGED": (
        "It judges by the number alone, which another set of runs would have put elsewhere.",
        "Hold the whole interval against the margin: what is not surely good enough is refused.",
    ),
    "BURDEN_REVERSED": (
        "It refuses only what is surely too bad, so an interval that nobody can tell anything from is "
        "accepted.",
        "Accept only what is surely good enough: both ends of the interval inside the margin.",
    ),
    "OVER_COVERAGE_ACCEPTED": (
        "A coverage above its margin passes: a sigma so wide that it covers everything.",
        "The coverage has two limits: refuse it below coverage_min and above coverage_max.",
    ),
    "RMSE_ALONE_JUDGED": (
        "Only the rmse is ever held against its margin.",
        "Each of bias, coverage, lag and rmse has a margin and a reason of its own.",
    ),
    "SIGN_OF_LIMIT_IGNORED": (
        "A negative number passes whatever its size.",
        "The margin of bias and of lag reaches to both sides of zero: too early is as wrong as too late.",
    ),
    "SIGMA_NOT_SCALED": (
        "The interval reaches one sigma to each side.",
        "The interval is y plus and minus 1.96 sigma, which should cover 95 %.",
    ),
    "REASON_MISSING": (
        "An interval leaves its margin and the reason is not given.",
        "Hold every interval against its margin, and collect every reason that applies: bias, coverage, lag, "
        "rmse.",
    ),
    "REASON_TOO_MANY": (
        "A reason is given although its interval keeps the margin.",
        "Hold each interval against its own margin, both ends.",
    ),
    "NOT_SORTED": (
        "The reasons are right and not in order.",
        "Sort them by alphabet.",
    ),
    "VERDICT_AGAINST_REASONS": (
        "The verdict does not go with the reasons.",
        "accepted is True exactly where there is no reason against it.",
    ),
}
