"""The mistakes that the checks of ``validation`` recognise, in words.

Each code says what the submission looks like and what to change. ``probes.py`` and ``probes_runs.py`` find
which one it is.
"""

from __future__ import annotations

from course.grading import kit
from course.grading.kit import Diagnosis

#: code: (what it looks like, what to change)
WORDS: dict[str, tuple[str, str]] = {
    # -- sizes of errors
    "ROOT_MISSING": (
        "It is the mean square: the root at the end is missing.",
        "Take the square root of the mean, so that the result has the unit of the error again.",
    ),
    "MEAN_REMOVED": (
        "It is the standard deviation: the mean is taken off first, so a constant error counts for nothing.",
        "Square the errors as they are. A simulation that is always off by the same amount is wrong, too.",
    ),
    "MEAN_ABSOLUTE": (
        "It is the mean of the absolute errors.",
        "Square instead of taking the absolute value, or keep the sign where a bias is asked for.",
    ),
    "NOT_AVERAGED": (
        "It is the root of the sum: it grows with the number of samples.",
        "Divide the sum of squares by N before taking the root.",
    ),
    "DDOF_ONE": (
        "It divides by N - 1.",
        "Divide by N: the task describes these very errors and estimates nothing about others. In numpy, "
        "ddof=0; statistics.variance divides by N - 1, statistics.pvariance by N.",
    ),
    "BIAS_FOR_RMSE": (
        "It is the mean: positive and negative errors cancel.",
        "Square each error before averaging.",
    ),
    "RETURNS_SWAPPED": (
        "The right two values come in the wrong order.",
        "Return them in the order of the README: (bias, variance), (lo, hi), peak and impulse by name.",
    ),
    "MEDIAN_FOR_MEAN": (
        "The bias is the median.",
        "Take the mean. The median ignores the rare large errors that a bias must count.",
    ),
    "WRONG_SIGN": (
        "The sign is the other way round.",
        "An error is simulated minus real; do not take the difference the other way.",
    ),
    "STD_FOR_VARIANCE": (
        "The second value is the standard deviation.",
        "The variance is the mean of the squared deviations, without a root.",
    ),
    "VARIANCE_ABOUT_ZERO": (
        "The second value is the mean square: the bias is still in it.",
        "Take the mean off before squaring. Then mean square = bias squared + variance.",
    ),
    "CANCELLATION": (
        "It is right for small errors and loses its digits where the mean is much larger than the scatter.",
        "mean(e**2) - mean(e)**2 is the difference of two huge numbers. Subtract the mean first, then "
        "square.",
    ),
    "MUTATES_INPUT": (
        "The caller still needs the old numbers.",
        "Write e = e - ..., which makes a new array, instead of e -= ... or e[...] = ..., which change "
        "the caller's.",
    ),
    # -- angles
    "NOT_WRAPPED": (
        "It returns the angles as they came.",
        "Take off whole turns until each lies between minus half a turn and half a turn. The angles are in "
        "radians: half a turn is pi.",
    ),
    "WRAPPED_ONCE": (
        "It takes off one turn at most, and an error may be many turns away.",
        "Use the remainder of a division by a turn, which takes off as many as there are.",
    ),
    "ZERO_TO_TURN": (
        "Its results lie between zero and a whole turn.",
        "A small negative error must stay small: add half a turn, take the remainder, and take half a turn "
        "off again.",
    ),
    "HALF_TURNS": (
        "It takes off half turns, so forwards and backwards become the same.",
        "The period of a direction is 2 pi.",
    ),
    "FOLDED": (
        "It folds angles back: the second half of a half turn comes out as the first.",
        "arcsin and arccos cannot tell two directions apart; arctan2(sin, cos) can.",
    ),
    "CLIPPED": (
        "It cuts large angles off at half a turn.",
        "Take off whole turns; what is left is the angle, and a limit is not.",
    ),
    "IN_DEGREES": (
        "It takes the angles for degrees.",
        "Angles are in radians: a turn is 2 pi.",
    ),
    "REMAINDER_SIGN": (
        "It is right for positive angles and not for negative ones.",
        "math.fmod and np.fmod keep the sign of what is divided. Python's % and np.mod take that of the "
        "divisor, which is what you need here.",
    ),
    # -- consistency
    "DIVIDED_BY_D": (
        "It is divided by the number of components.",
        "Leave it whole: its average over a consistent estimate is d, and the band is made for that.",
    ),
    "ROOT_TAKEN": (
        "It is the distance, not its square.",
        "Leave out the root: the squared distance is what follows a chi-square distribution.",
    ),
    "DIAGONAL_ONLY": (
        "It uses the variances alone and ignores that errors of two components go together.",
        "Use the whole matrix: solve P w = err for w, then sum err * w.",
    ),
    "NOT_INVERTED": (
        "It multiplies by the covariance where it should divide.",
        "Solve P w = err for w and sum err * w. A large covariance forgives a large error.",
    ),
    "INVERTED_BY_ELEMENT": (
        "It divides by each element of the matrix.",
        "The inverse of a matrix is not the matrix of the inverses: use np.linalg.solve or np.linalg.inv.",
    ),
    "UNWEIGHTED": (
        "It is the plain squared length and ignores the covariance.",
        "Solve P w = err for w and sum err * w.",
    ),
    "SUMMED": (
        "It is one number for all samples together.",
        "Return one value per row of err.",
    ),
    "ONE_SIDED": (
        "Each end leaves alpha outside, so both together leave twice as much.",
        "Split alpha: half of it below lo and half above hi.",
    ),
    "LEVEL_FOR_ALPHA": (
        "It takes alpha for the share that lies inside.",
        "alpha lies outside: the ends are the quantiles at alpha/2 and 1 - alpha/2.",
    ),
    "NOT_DIVIDED_BY_RUNS": (
        "It is the band of the sum over the runs, not of their average.",
        "Divide both quantiles by the number of runs.",
    ),
    "RUNS_IGNORED": (
        "It is the band of a single run: averaging does not narrow it.",
        "The sum over the runs is chi-square with dof * runs degrees of freedom; take its quantiles and "
        "divide by runs.",
    ),
    "DIVIDED_BY_DOF": (
        "It is divided by the degrees of freedom as well.",
        "NEES is not divided by d, and neither is its band: divide by runs only.",
    ),
    "NORMAL_BAND": (
        "It is the band of a normal distribution: symmetric, which a chi-square is not.",
        "Use quantiles of the chi-square distribution; the hints give two ways without scipy.",
    ),
    "ROUGH_QUANTILES": (
        "It is near the right band and off by more than 1 %: the quantiles are too rough.",
        "dof * runs, alpha/2 and the division seem right. Use an approximation that bends as the chi-square "
        "does, or the distribution itself; the hints have both.",
    ),
    # -- coverage
    "COVERAGE_OPEN_BOUNDS": (
        "A value that lies exactly on an end is not counted.",
        "The intervals are closed: use <= on both sides.",
    ),
    "IN_PER_CENT": (
        "It is a hundred times too large.",
        "Return a share: one is everything.",
    ),
    "COUNTED": (
        "It is the number of values inside.",
        "Divide by how many values there are.",
    ),
    "OUTSIDE_COUNTED": (
        "It is the share that lies outside.",
        "Count where lo <= y <= hi.",
    ),
    # -- bootstrap
    "IID_BOOTSTRAP": (
        "It draws samples one by one, as if neighbours had nothing to do with each other, and so the "
        "interval is far too narrow.",
        "Draw whole blocks: choose starting points at random and take block samples in a row from each.",
    ),
    "NOT_RESAMPLED": (
        "Every resample is the series itself.",
        "Draw the starting points of the blocks at random, with replacement, anew for each resample.",
    ),
    "BLOCK_IGNORED": (
        "The blocks are not as long as they should be.",
        "Each block has block samples in a row (on average, if you draw lengths too).",
    ),
    "RESAMPLE_SIZE": (
        "The resamples are not as long as the series.",
        "Join blocks until there are at least N samples and cut off what is too much; N need not be a "
        "multiple of block.",
    ),
    "DRAWN_ONCE": (
        "Every resample is the same one.",
        "Draw new starting points for each resample, inside the loop.",
    ),
    "OTHER_NUMBER_OF_RESAMPLES": (
        "It does not make n_boot resamples, or asks the statistic more than once about each.",
        "Draw n_boot resamples and call statistic once for each; a basic interval asks about the series "
        "itself once more.",
    ),
    "STATISTIC_IGNORED": (
        "The interval is not made of what the given statistic says about each resample.",
        "Call statistic(samples) for each resample and keep what it returns; it need not be the mean.",
    ),
    "ONE_STANDARD_ERROR": (
        "The width does not follow alpha as that of a confidence interval does.",
        "Take the quantiles of the resampled values at alpha/2 and 1 - alpha/2.",
    ),
    "GLOBAL_RNG": (
        "The same generator in the same state gives another interval.",
        "Take every draw from rng: not from np.random, not from random, not from a generator of your own.",
    ),
    "FIXED_SEED": (
        "Another generator gives the very same interval.",
        "Take every draw from rng; do not make a generator of your own with a fixed seed.",
    ),
    "ENDS_ON_ONE_SIDE": (
        "Both ends are among the smallest of the resampled values.",
        "One quantile belongs at alpha/2 and one at 1 - alpha/2. np.quantile counts from 0 to 1, "
        "np.percentile from 0 to 100.",
    ),
    "NOT_CENTRED": (
        "The interval does not lie around the statistic of the series.",
        "A percentile interval is made of the resampled values as they are; a basic one mirrors them at "
        "the statistic of the series.",
    ),
    # -- energy and contact
    "WHOLE_ARRAYS": (
        "It hands over a whole run where one sample is asked for.",
        "Loop over the samples: energy(q[i], v[i]) gives one number.",
    ),
    "NOT_ABSOLUTE": (
        "It divides by the first energy with its sign, and so a gain looks like a loss where energies are "
        "negative.",
        "Divide by abs(E[0]). An orbit has negative energy, and so has a pendulum below its pivot.",
    ),
    "TO_CURRENT": (
        "It divides by the energy at each moment.",
        "Divide by the size of the first energy throughout, or a collapse to zero looks infinite.",
    ),
    "TO_PREVIOUS": (
        "It compares each sample with the one before.",
        "Compare with the first sample: a slow drift is invisible from step to step.",
    ),
    "UNSIGNED": (
        "It has lost the sign.",
        "Leave abs out: whether there is too much or too little is half of the answer.",
    ),
    "NOT_RELATIVE": (
        "It is a difference and not divided by anything.",
        "Divide by what the README says, so that the result has no unit.",
    ),
    "RATIO": (
        "It is a quotient: one where there is no error.",
        "Take one off: (simulated - real) / real.",
    ),
    "PEAK_OF_ERROR": (
        "The peak is that of the difference of the two forces: an impact that comes a moment late looks "
        "like one of the wrong strength.",
        "Take the peak of each force on its own, then compare the two numbers.",
    ),
    "PEAK_AT_SAME_TIME": (
        "It compares both forces at the moment at which the real one peaks.",
        "Take the peak of each force on its own, wherever it lies.",
    ),
    "DIVIDED_BY_SIM": (
        "It is relative to the simulation.",
        "Divide by the real value: reality is the yardstick.",
    ),
    "IMPULSE_OF_ABSOLUTE": (
        "The impulse is the integral of the absolute difference: an impact that comes a moment late "
        "counts twice.",
        "Integrate each force on its own, then compare the two numbers.",
    ),
    # -- cross-validation
    "LEAKS_HELD_OUT": (
        "A model is asked about runs that it was fitted to.",
        "For each fold, fit to all the runs outside it and predict those inside it. Errors on runs a "
        "model has seen say how well it remembers.",
    ),
    "FITS_ONCE": (
        "It fits a single model to all runs, so nothing is held out.",
        "Fit anew for each fold, without the runs of that fold.",
    ),
    "SCORES_TRAINING": (
        "It scores each model on the runs it was fitted to and leaves the fold out.",
        "Predict the runs of the fold: those that fit did not get.",
    ),
    "FITS_THE_FOLD": (
        "Each model is fitted to the runs of its own fold.",
        "The fold is what is held out: fit to all the other runs, and predict those of the fold.",
    ),
    "NOT_CONTIGUOUS": (
        "The folds are not contiguous pieces of the list.",
        "The first fold is the first runs, and so on. Neighbouring runs resemble each other: dealing or "
        "shuffling them lets a model see a twin of what it must predict.",
    ),
    "FOLDS_UNEVEN": (
        "The folds are not k pieces of nearly the same length, or some run is in none of them.",
        "np.array_split(range(len(runs)), k) gives k pieces whose sizes differ by at most one.",
    ),
    "TRAINS_ON_TOO_LITTLE": (
        "A model is not fitted to all the runs outside its fold.",
        "Hand fit every run that is not held out.",
    ),
    "MEAN_OF_RUNS": (
        "It averages one RMSE per run. The mean of roots is not the root of the mean, and a short run "
        "would count as much as a long one.",
        "Pool all samples first, then take one root of the mean square.",
    ),
}
WORDS |= kit.companion("validation", "diagnosis_verdict").WORDS


def named(code: str) -> Diagnosis:
    """The diagnosis of that code."""
    looks_like, advice = WORDS[code]
    return Diagnosis(code, looks_like, advice)
