"""What a failed check of ``validation`` shows of the mistake behind it.

Each probe looks for a property that a family of mistakes has: the bootstrap is recognised by the resamples it
asks the statistic about and by what it makes of the answers, cross-validation by who was fitted to what.
Which known wrong formula it is, ``hypotheses.json`` tells. ``probes_verdict.py`` has the verdict.
"""

from __future__ import annotations

import functools
import itertools
import math
import statistics
from dataclasses import dataclass

import numpy as np

from course.scoring import kit

named = kit.words("validation")


def callback(signature, fn):
    """``fn`` as a counted callback that refuses any other number of arguments than ``signature`` has."""
    arity = signature.count(",") + 1

    def checked(*args, **kwargs):
        if kwargs or len(args) != arity:
            kit.fail(
                f"Your code calls {signature.partition('(')[0]} with other arguments than it takes.",
                help=f"Call it by position: {signature}.",
                diagnose="CALLED_WRONGLY",
                expected=signature,
                actual=[*args, *kwargs],
            )
        return fn(*args)

    return kit.counted(checked)


def of_whole(submission, task, args, fits):
    """Whether an answer is wrong only where the arrays are of whole numbers; fits: whether one is right."""
    if not any(isinstance(arg, np.ndarray) and arg.dtype.kind == "i" for arg in args):
        return None
    floats = [arg.astype(float) if isinstance(arg, np.ndarray) else arg for arg in args]
    return named("WHOLE_NUMBERS") if kit.attempt(lambda: fits(submission.call(task, *floats))) else None


# -- metrics --------------------------------------------------------------------------------------------


def of_digits(values, right):
    """Whether numbers are these but for their later digits."""
    values, right = np.asarray(values, dtype=float), np.asarray(right, dtype=float)
    return named("FEW_DIGITS") if np.allclose(values, right, rtol=1e-6, atol=0.0) else None


def of_offset(submission, e):
    """Why a variance is wrong where the mean is much larger than the scatter: it may be right elsewhere."""
    e = e - np.mean(e)
    # No whole number, which would hide rounding; and where a single digit after the sixth says nothing.
    near, small, far = _offs(submission, [e + 0.37, 1e-4 * (e + 0.37), e + 1e5 / 3])
    if 1e-10 < max(near) < 1e-5 and 1e-10 < max(small) < 1e-5:
        return named("SINGLE_PRECISION")
    # One pass loses some six digits of it there, and none of the bias.
    exact = max(near) < 1e-10 and far[0] < 1e-12
    return named("CANCELLATION") if exact and 1e-12 < far[1] < 1e-3 else None


def _offs(submission, series):
    """How far bias and variance of each of these are off, relative to the right ones."""
    for e, value in zip(series, submission.call_each("bias_variance", [(e,) for e in series]), strict=True):
        pair = kit.as_tuple(value, ("bias", "variance"))
        bias, variance = (kit.as_number(x, name) for x, name in zip(pair, ("bias", "variance"), strict=True))
        yield abs(bias / np.mean(e) - 1), abs(variance / np.var(e) - 1)


def of_rows(rows, right):
    """Whether only the first of several rows was computed."""
    alone = len(rows) > 1 and math.isclose(rows[0], right[0], rel_tol=1e-8) and np.ptp(rows[1:]) == 0
    return named("FIRST_ROW_ALONE") if alone and rows[1] in {0.0, 1.0} else None


def of_force(key, value, f_sim, f_real, dt):
    """What a wrong relative error of the peak or the impulse is; the other may be wrong in another way."""
    of = np.max if key == "peak" else np.sum
    sim, real = of(f_sim), of(f_real)
    if value == -1:  # nothing is left of the simulated force, by whatever rule
        return None
    ratios = {
        "peak": [
            ("PEAK_OF_ERROR", np.max(f_sim - f_real) / real),
            ("PEAK_OF_ERROR", np.max(np.abs(f_sim - f_real)) / real),
            ("PEAK_AT_SAME_TIME", f_sim[np.argmax(f_real)] / real - 1),
            ("PEAK_AT_SAME_TIME", sim / f_real[np.argmax(f_sim)] - 1),
            *(("PEAK_NOT_LARGEST", of(f_sim) / of(f_real) - 1) for of in _OTHER_PEAKS),
        ],
        "impulse": [
            ("IMPULSE_OF_ABSOLUTE", np.sum(np.abs(f_sim - f_real)) / real),
            ("IMPULSE_OF_PEAK", np.max(f_sim) / np.max(f_real) - 1),
            ("IMPULSE_AT_SAME_TIME", np.sum(f_sim[f_real > 0]) / real - 1),
            ("IMPULSE_AT_SAME_TIME", sim / max(np.sum(f_real[f_sim > 0]), 1e-12) - 1),
            (
                "IMPULSE_OF_SQUARES",
                np.sum(np.square(f_sim, dtype=float)) / np.sum(np.square(f_real, dtype=float)) - 1,
            ),
            ("MEAN_FORCE", np.mean(f_sim[f_sim > 0]) / np.mean(f_real[f_real > 0]) - 1),
        ],
    }
    looks = [
        *ratios[key],
        ("WRONG_SIGN", (real - sim) / real),
        ("DIVIDED_BY_SIM", (sim - real) / sim),
        ("RATIO", sim / real),
        ("RATIO", real / sim),
        ("IN_PER_CENT", 100 * (sim - real) / real),
        ("NOT_RELATIVE", sim - real),
        ("NOT_RELATIVE", (sim - real) * dt),
        ("DIVIDED_BY_BOTH", 2 * (sim - real) / (sim + real)),
        ("DIVIDED_BY_BOTH", (sim - real) / max(sim, real)),
    ]
    codes = {code for code, wrong in looks if math.isclose(value, wrong, rel_tol=2e-3)}
    return named(codes.pop()) if len(codes) == 1 else None


def _vertex(f):
    """The highest point of the parabola through the largest sample and its neighbours."""
    a, b, c = np.asarray(f[(i := int(np.clip(np.argmax(f), 1, len(f) - 2))) - 1 : i + 2], dtype=float)
    return b + (a - c) ** 2 / (8 * (2 * b - a - c)) if 2 * b > a + c else b


#: What is taken for a peak.
_OTHER_PEAKS = (_vertex, *(functools.partial(np.percentile, q=q) for q in (90, 95, 98, 99, 99.5)))

#: dof and runs, 40 degrees of freedom in all.
_FEWER = ((5, 8), (8, 5))


def of_band(submission, setting, ends, right):
    """What the (lo, hi) of a wrong band are beside the right ones, and what they do not depend on.

    setting: (dof, runs, alpha)
    """
    dof, runs, alpha = setting
    # With fewer degrees of freedom, too: a search that ends too early ends at the same place for every alpha.
    if not any(_alpha_matters(submission, *size) for size in ((dof, runs), *_FEWER)):
        return named("ALPHA_IGNORED")
    # That of a chi-square lies higher by far more than rounding: (2/9 z² - 2/3)/runs and the like.
    if abs(sum(ends) / 2 - dof) < 1e-9 * dof and ends[0] < ends[1]:
        return named("NORMAL_BAND")
    # At several levels: a band made by chance is right at one or two of them.
    levels = (alpha, 0.01, 0.2)
    if dof * runs > 40 and all(_right_for_forty(submission, *size, one) for size in _FEWER for one in levels):
        return named("FEW_DEGREES_ONLY")
    return named("ROUGH_QUANTILES") if np.allclose(ends, right, rtol=0.2) else None


def of_random_band(submission, setting):
    """Whether a band is another one when it is asked for again."""
    bands = [kit.as_vector(band, 2) for band in submission.call_each("consistency_band", [setting, setting])]
    return None if np.array_equal(*bands) else named("BAND_BY_CHANCE")


def _alpha_matters(submission, dof, runs):
    """Whether the band is another one for another alpha."""
    bands = submission.call_each("consistency_band", [(dof, runs, level) for level in (0.01, 0.08, 0.2)])
    pairs = [kit.attempt(lambda band=band: kit.as_vector(band, 2)) for band in bands]
    return not all(pair is not None and np.array_equal(pair, pairs[0]) for pair in pairs)


def _right_for_forty(submission, dof, runs, alpha):
    """Whether a band is right, where dof * runs is 40."""
    [band] = submission.call_each("consistency_band", [(dof, runs, alpha)])
    ends = kit.attempt(lambda: kit.as_vector(band, 2))
    z = statistics.NormalDist().inv_cdf(1 - alpha / 2)
    # Wilson and Hilferty's cube is off by 0.2 % here at most, with any alpha from 0.01; 1 % is asked for.
    right = dof * (1 - 2 / 360 + np.array([-z, z]) * math.sqrt(2 / 360)) ** 3
    return ends is not None and np.allclose(ends, right, rtol=0.012)


# -- bootstrap ------------------------------------------------------------------------------------------

#: Blocks found may be this much longer or shorter than asked for. Over 24 resamples of 21 blocks the mean
#: length of random (stationary) blocks scatters by 5 %; blocks that are not random are off by 5 % at most.
BLOCK_FACTOR = 1.5
#: No multiple of the block: what is too much at the end has to be cut off.
_N, _BLOCK, _BOOT, _ALPHA = 250, 12, 24, 0.2


@dataclass(frozen=True)
class Resampled:
    """One bootstrap of a series whose values say where they stand.

    Attributes:
        e: the series.
        asked: every array the statistic was asked about.
        answers: what it answered.
        inspected: what the submission returned, and what became of e.
    """

    e: np.ndarray
    asked: list
    answers: list
    inspected: kit.Inspected

    @property
    def drawn(self):
        """The resamples: what the statistic was asked about beside the series itself."""
        return [samples for samples in self.asked if not np.array_equal(samples, self.e)]

    @property
    def values(self):
        """What it answered about the resamples."""
        asked = zip(self.asked, self.answers, strict=True)
        return np.array([answer for samples, answer in asked if not np.array_equal(samples, self.e)])

    @property
    def ends(self):
        """The (lo, hi) that came back."""
        return kit.as_vector(kit.as_tuple(self.inspected.value, ("lo", "hi")), 2, "(lo, hi)")


def resample(submission, seed, count=_BOOT, blocks=_N / _BLOCK):
    """Have the submission make a few resamples, and look at them."""
    e = 1.0 + np.arange(round(_BLOCK * blocks))  # no zero, which an array that was not filled has
    answers = []

    def statistic(samples):
        values = kit.as_vector(samples, None, "samples")
        # Not the mean, so that a submission that takes means of its own is seen.
        answers.append(float(np.sum(values**2)) / max(len(values), 1))
        return answers[-1]

    probe = callback("statistic(samples)", statistic)
    inspected = probe.during(
        lambda: submission.call_inspect(
            "block_bootstrap_ci", e, probe, _BLOCK, count, _ALPHA, np.random.default_rng(seed)
        )
    )
    asked = [np.asarray(call[0], dtype=float) for call in probe.calls]
    return Resampled(e, asked, answers, inspected)


def of_resamples(found):
    """What is wrong with the resamples, as a code, or None."""
    drawn, n = found.drawn, len(found.e)
    whole = all(len(samples) == n for samples in drawn)
    length = _length_of_blocks(drawn) if drawn and whole else math.nan
    looks = [
        ("STATISTIC_IGNORED", not drawn and len(found.asked) < 2),
        ("NOT_RESAMPLED", not drawn),
        ("STATISTIC_OF_BLOCKS", not whole and all(map(_one_block, drawn))),
        ("RESAMPLE_SIZE", not whole),
        ("NOT_OF_THE_SERIES", not np.isin(np.concatenate([found.e, *drawn]), found.e).all()),
        # Of errors drawn with replacement a third is missing in a resample.
        ("REPEATS_AN_END", _repeated_ends(drawn, found.e) >= _MOST_REPEATED),
        ("DRAWN_WITHOUT_REPLACEMENT", all(len(np.unique(samples)) > 0.9 * n for samples in drawn)),
        ("DRAWN_ONCE", len(drawn) > 1 and all(np.array_equal(samples, drawn[0]) for samples in drawn)),
        ("ONE_BLOCK_REPEATED", len(drawn) > 1 and all(map(_repeats_its_block, drawn))),
        ("STARTS_AMONG_FIRST", len(drawn) > _BOOT / 2 and _starts_among_first(drawn)),
        # Five hundred blocks, drawn anywhere, leave out no more than an error at an end of the series.
        ("PART_OF_SERIES", len(drawn) > _BOOT / 2 and len(np.unique(np.concatenate(drawn))) < 0.8 * n),
        ("BEGINNING_REPEATED", len(drawn) > _BOOT / 2 and all(map(_ends_as_it_begins, drawn))),
        ("IID_BOOTSTRAP", length < 1.5),
        ("BLOCK_IGNORED", not _BLOCK / BLOCK_FACTOR <= length <= _BLOCK * BLOCK_FACTOR),
        ("BLOCKS_OF_OTHER_LENGTH", bool(drawn) and _usual_length(drawn) not in (None, _BLOCK)),
        ("BLOCKS_CUT_SHORT", bool(drawn) and _cut_short(drawn, found.e) >= _MOST_CUT),
        # In three of five resamples, a block begins where another one does.
        ("BLOCKS_DRAWN_ONCE", len(drawn) >= _BOOT and not any(map(_begins_twice, drawn))),
        # A basic interval asks about the series itself, once or where it is needed.
        ("OTHER_NUMBER_OF_RESAMPLES", len(drawn) != _BOOT or len(found.asked) > _BOOT + 2),
    ]
    return next((code for code, fits in looks if fits), None)


#: Of some five hundred places where one block ends and another begins, one in 62,500 has the same end of the
#: series on both sides, and one in 250 the same sample; of blocks that are filled up with the last sample of
#: the series, one in twenty repeats it.
_MOST_REPEATED = 5


def _repeated_ends(drawn, e):
    """How much oftener the first or last sample of the series follows itself than all others do together."""
    twice = np.concatenate([np.empty(0), *(samples[1:][np.diff(samples) == 0] for samples in drawn)])
    ends = int(np.sum(np.isin(twice, (e[0], e[-1]))))
    return 2 * ends - len(twice)


#: Of blocks of one length that fit into the series, or go on at its start, none is ever cut short at its last
#: sample. If a fifth of them has another length, by whatever rule, 0.42 of five hundred end there on average
#: and eight or more with a chance of 2e-8. Of blocks that a slice cuts off, it is 23 of five hundred.
_MOST_CUT = 8


def _cut_short(drawn, e):
    """How many blocks end at the last sample of the series before they are complete, if the others are of the
    length that was asked for; blocks of random length may end anywhere."""
    if _usual_length(drawn) != _BLOCK:
        return 0
    begun = [_beginnings(samples) for samples in drawn]
    return sum(
        int(np.sum((np.diff(places) < _BLOCK) & (samples[places[1:] - 1] == e[-1])))
        for places, samples in zip(begun, drawn, strict=True)
    )


def _ends_as_it_begins(samples):
    """Whether what is left after the whole blocks is the beginning once more, which chance hardly does."""
    return np.array_equal(samples[-(_N % _BLOCK) :], samples[: _N % _BLOCK])


def _one_block(samples):
    """Also one that goes on at the start of the series, which is 1."""
    return len(samples) == _BLOCK and bool(np.all((np.diff(samples) == 1) | (samples[1:] == 1)))


def _repeats_its_block(samples):
    """Whether a resample is its first block, again and again."""
    return _one_block(samples[:_BLOCK]) and np.array_equal(samples, np.resize(samples[:_BLOCK], len(samples)))


def _starts_among_first(drawn):
    """Whether blocks begin among the first N/block samples, as if the number of a block were its start."""
    if _usual_length(drawn) != _BLOCK:
        return False
    begun = [samples[_beginnings(samples)[:-1]] for samples in drawn]
    return max(map(np.max, begun)) <= math.ceil(_N / _BLOCK)  # e begins with 1


def _beginnings(samples):
    """Where blocks begin in a resample; a circular block goes on at the start of the series."""
    steps = np.diff(samples)
    return np.flatnonzero(np.append(True, (steps != 1) & (steps != 1 - len(samples))))


def _begins_twice(samples):
    begun = samples[_beginnings(samples)]
    return len(np.unique(begun)) < len(begun)


def _usual_length(drawn):
    """The length of four in five blocks, if they have one; the last block of a resample is cut off."""
    lengths = np.concatenate([np.diff(_beginnings(samples)) for samples in drawn])
    usual = int(np.median([*lengths, 0, 0]))
    return usual if np.sum(lengths == usual) > 0.8 * max(len(lengths), 1) else None


def _length_of_blocks(drawn):
    """How many neighbours follow each other in these resamples, on average."""
    return len(drawn[0]) * len(drawn) / sum(len(_beginnings(samples)) for samples in drawn)


def of_ends(found):
    """What is wrong with the ends of an interval, given the resampled values, as a code, or None."""
    ends, whole = kit.attempt(lambda: found.ends), float(np.mean(found.e**2))
    if ends is None or len(found.drawn) < 3 or _normal(ends, found.values, whole):
        return None
    values, means = found.values, np.array([np.mean(samples) for samples in found.drawn])
    a = _ALPHA
    levels = [
        (None, a / 2, 1 - a / 2),
        ("ONE_SIDED", a, 1 - a),
        ("ALPHA_AT_ONE_END", a / 2, 1 - a),
        ("ALPHA_AT_ONE_END", a, 1 - a / 2),
        ("LEVEL_FOR_ALPHA", (1 - a) / 2, (1 + a) / 2),
        ("ENDS_ON_ONE_SIDE", a / 200, (1 - a / 2) / 100),
    ]
    for code, low, high in levels:
        if _quantiles(ends, values, low, high) or _quantiles(2 * whole - ends[::-1], values, low, high):
            return code
    for _, low, high in levels:
        if _quantiles(ends[::-1], values, low, high) or _quantiles(2 * whole - ends, values, low, high):
            return "RETURNS_SWAPPED"
    if any(_quantiles(ends, means, low, high) for _, low, high in levels):
        return "STATISTIC_IGNORED"
    if any(_quantiles(ends + whole, values, low, high) for _, low, high in levels):
        return "NOT_CENTRED"
    return "WIDTH_SCALED" if _scaled(ends, values, whole) else None


def _normal(ends, values, whole):
    """Whether it is a normal interval: as far to either side of a middle as the resampled values scatter.

    The middle may be corrected for a bias, and the factor may be Student's; no other rule has the same middle
    but by chance.
    """
    wide, mean = float(np.std(values)), float(np.mean(values))
    factor = statistics.NormalDist().inv_cdf(1 - _ALPHA / 2)
    near = [abs(np.mean(ends) - middle) <= 1e-9 * abs(whole) for middle in (whole, mean, 2 * whole - mean)]
    return any(near) and 0.9 * factor * wide <= (ends[1] - ends[0]) / 2 <= 1.15 * factor * wide


def _scaled(ends, values, whole):
    """Whether the ends lie about the statistic, or the middle of the values, like the right ones, but much
    nearer or farther."""
    right = np.quantile(values, [_ALPHA / 2, 1 - _ALPHA / 2])
    if np.isin(ends, values).all():  # other quantiles
        return False
    for centre in (whole, np.mean(values), np.median(values), np.mean(right)):
        low, high = (ends - centre) / (right - centre)
        if low > 0 and abs(low / high - 1) < 0.02 and not 0.8 < low < 1.25:
            return True
    return False


def of_chance(submission):
    """Whether two generators give the very same resamples, so that chance comes from elsewhere."""
    first, other = (resample(submission, seed) for seed in (1, 2))
    alike = len(first.asked) == len(other.asked) and all(map(np.array_equal, first.asked, other.asked))
    return named("FIXED_SEED") if alike else None


def _quantiles(ends, values, low, high):
    """Whether both ends are these quantiles, by whatever rule between two neighbours."""
    ordered = np.sort(values)
    for end, share in zip(ends, (low, high), strict=True):
        place = share * (len(ordered) - 1)
        least = ordered[max(0, math.floor(place - 0.6))]
        most = ordered[min(len(ordered) - 1, math.ceil(place + 0.6))]
        slack = 1e-9 * (abs(least) + abs(most))
        if not least - slack <= end <= most + slack:
            return False
    return True


def of_interval(submission, seed, found=None, *, ends_first=False):
    """The mistake behind a wrong interval, if the resamples or what is made of them show it.

    Args:
        found: the resamples, if they have been looked at.
        ends_first: of two mistakes, the one in what is made of the resamples.
    """
    found = found or resample(submission, seed)
    code = of_ends(found) or of_resamples(found) if ends_first else of_resamples(found) or of_ends(found)
    # Few values are near each other: ask for more.
    if code in {None, "ONE_SIDED", "ALPHA_AT_ONE_END", "LEVEL_FOR_ALPHA", "WIDTH_SCALED"}:
        many = resample(submission, seed, 10 * _BOOT)
        width, narrow = (kit.attempt(lambda some=some: np.diff(some.ends)[0]) for some in (found, many))
        picked = kit.attempt(lambda: _of_picked(many)) if code in {None, "WIDTH_SCALED"} else None
        if picked:
            code = picked
        elif width and narrow and 0 < narrow < 0.5 * width:
            code = "SHRINKS_WITH_RESAMPLES"
        elif code:
            code = of_ends(many)
    return named(code) if code else None


def _of_picked(found):
    """Which of many resampled values the ends are, if they are picked as they came or for one alpha."""
    ends, values = found.ends, found.values
    places = len(values) * np.array([_ALPHA / 2, 1 - _ALPHA / 2])
    pairs = zip(ends, places, strict=True)
    if all(np.any(np.abs(np.flatnonzero(values == end) - place) < 1.5) for end, place in pairs):
        return "ENDS_UNSORTED"
    return "FIXED_LEVELS" if _quantiles(ends, values, 0.025, 0.975) else None


# -- cross-validation -----------------------------------------------------------------------------------


class Folds:
    """A fit and a predict that remember which runs they are given.

    The model is y = gain * u, least squares. A run is known by its ``u``, so it may come back as a copy and
    without its ``y``.

    Attributes:
        fitted: for each model, the places of its training runs.
        asked: for each model, the places of the runs it was to predict.
    """

    def __init__(self, runs):
        self.runs = runs
        self._places = {_bits(run["u"]): i for i, run in reversed([*enumerate(runs)])}
        self.fitted: list[list[int]] = []
        self.asked: list[list[int]] = []
        self._gains: list[float] = []

    def fit(self, runs):
        places = [self._place(run, "fit") for run in kit.as_list(runs, "what fit was given")]
        # Before the first run, a fit to no run at all has a model, too: what is wrong is said afterwards.
        u, y = (np.concatenate([np.empty(0), *(self.runs[i][key] for i in places)]) for key in ("u", "y"))
        self.fitted.append(places)
        self.asked.append([])
        self._gains.append(float(u @ y / (u @ u)) if places else 0.0)
        return {"model": len(self.fitted) - 1}

    def predict(self, model, run):
        number = model.get("model") if isinstance(model, dict) else None
        if type(number) is not int or not 0 <= number < len(self.fitted):
            kit.fail(
                "Your code passes something to predict that fit did not return.",
                help="Keep what fit returns as it is, and pass it to predict first: predict(model, run).",
                diagnose="NOT_A_MODEL",
                expected="a model that fit returned",
                actual=model,
            )
        place = self._place(run, "predict")
        self.asked[number].append(place)
        return self._gains[number] * self.runs[place]["u"]

    def _place(self, run, function):
        u = np.asarray(run.get("u"), dtype=float) if isinstance(run, dict) and "u" in run else np.empty(0)
        place = self._places.get(_bits(u))  # most come back bit by bit
        if place is None:
            place = next((i for i, known in enumerate(self.runs) if np.array_equal(u, known["u"])), None)
        if place is None:
            kit.fail(
                f"Your code hands {function} something that is not one of the runs.",
                help="fit gets a list of runs, predict gets a model and one run, each as it was in the list.",
                diagnose="NOT_A_RUN",
                expected="a run of the list",
                actual=run,
            )
        return place

    def cross_validate(self, submission, k):
        """What the submission returns, and what became of the runs."""
        fit, predict = callback("fit(runs)", self.fit), callback("predict(model, run)", self.predict)
        return fit.during(
            lambda: predict.during(
                lambda: submission.call_inspect("cross_validate", fit, predict, self.runs, k)
            )
        )

    def fault(self, k):
        """What is wrong with who was fitted to what, as a code, or None."""
        used = [(set(fit), asked) for fit, asked, _ in self._folds()]
        everything = set(range(len(self.runs)))
        if not used or _fits_the_fold(used, everything):
            return "FITS_THE_FOLD" if used else "NEVER_PREDICTS"
        if len(used) == 1 and used[0][0] == everything:
            return "FITS_ONCE"
        if any(fit & set(asked) for fit, asked in used):
            swapped = all(fit == set(asked) for fit, asked in used)
            return "SCORES_TRAINING" if swapped and used[0][0] != everything else "LEAKS_HELD_OUT"
        if any(asked[-1] - asked[0] + 1 != len(asked) for _, asked in used):
            return "NOT_CONTIGUOUS"
        sizes = [len(asked) for _, asked in used]
        covered = sorted(i for _, asked in used for i in asked) == sorted(everything)
        if len(used) != k or not covered or max(sizes) - min(sizes) > 1:
            uneven = "FOLD_SIZES" if len(used) == k and covered else "FOLDS_UNEVEN"
            return "ONE_RUN_LEFT_OUT" if _leaves_one_out(used, everything) else uneven
        return None if all(fit == everything - set(asked) for fit, asked in used) else "TRAINS_ON_TOO_LITTLE"

    def of_order(self, scores):
        """Whether wrong scores are the right ones in another order."""
        right = [math.sqrt(np.mean(np.concatenate(fold) ** 2)) for fold in self.residuals()]
        return named("FOLDS_IN_OTHER_ORDER") if np.allclose(np.sort(scores), np.sort(right), 1e-9) else None

    def residuals(self):
        """For each fold in the order of the list, the errors of its runs, one array each."""
        return [
            [gain * self.runs[i]["u"] - self.runs[i]["y"] for i in asked]
            for _, asked, gain in sorted(self._folds(), key=lambda fold: fold[1])
        ]

    def _folds(self):
        """(fitted to, asked about, gain) of the models that were asked.

        Models that are fitted anew to the same runs, one after the other for each run of a fold, are one.
        """
        models = [m for m, asked in enumerate(self.asked) if asked]
        for fit, same in itertools.groupby(models, key=lambda m: tuple(sorted(self.fitted[m]))):
            alike = list(same)
            asked = {i for m in alike for i in self.asked[m]}
            one = len(fit) > 0 and {*fit} == {*range(len(self.runs))} - asked
            for m in alike[:1] if one else alike:
                yield fit, sorted(asked if one else {*self.asked[m]}), self._gains[m]


def _bits(u):
    u = np.asarray(u, dtype=float)
    return u.shape, u.tobytes()


def _fits_the_fold(used, everything):
    """Whether each model saw one piece of the list, and no run was seen twice: the fold."""
    pieces = all(fit and max(fit) - min(fit) + 1 == len(fit) for fit, _ in used)
    once = sorted(i for fit, _ in used for i in fit) == sorted(everything)
    roles = all(set(asked) in (fit, everything - fit) for fit, asked in used)
    return len(used) > 2 and pieces and once and roles


def _leaves_one_out(used, everything):
    """Whether each run was predicted alone, by a model that had seen all the others."""
    return len(used) == len(everything) and all(
        len(asked) == 1 and fit == everything - set(asked) for fit, asked in used
    )
