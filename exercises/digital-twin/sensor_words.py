"""The mistakes that sensors of ``digital-twin`` make, in words: see ``diagnosis.py``."""

from __future__ import annotations

SENSORS: dict[str, tuple[str, str]] = {
    # -- encoder
    "COUNTS_AS_FLOATS": (
        "The numbers are whole, and their type is not.",
        "A counter has no fractions: end with .astype(np.int64).",
    ),
    "NOT_QUANTISED": (
        "The counts have fractions: the angle is converted but never quantised.",
        "Round the quotient: np.floor or np.rint, then .astype(np.int64).",
    ),
    "TRUNCATES_TOWARD_ZERO": (
        "The fraction is cut off toward zero, so the count stands still twice as long around zero: its "
        "errors have std 0.577 instead of 0.289 counts as soon as the angle takes both signs.",
        "int() and astype(int) cut toward zero. Use np.floor or np.rint first.",
    ),
    "ROUNDS_UP": (
        "The count is rounded up: it shows a tooth that has not passed yet.",
        "Use np.floor (a count is complete when its tooth has passed) or np.rint.",
    ),
    "TURNS_FORGOTTEN": (
        "The count starts over at each turn.",
        "An incremental encoder keeps counting: leave out the modulo, and let negative angles give negative "
        "counts.",
    ),
    "RADIANS_AS_TURNS": (
        "The angle is taken as a number of turns.",
        "One turn is 2 pi radians: divide by it.",
    ),
    "DEGREES_FOR_RADIANS": (
        "The angle is taken as degrees.",
        "theta is in radians: one turn is 2 pi.",
    ),
    "RETURNS_ANGLE": (
        "The result is the quantised angle, not the count behind it.",
        "Return the whole number of counts itself.",
    ),
    # -- imu
    "WHITE_NOISE_MISSING": (
        "The measured rate has no white noise on it.",
        "Add noise_density / sqrt(dt) times a standard normal number to each sample.",
    ),
    "WHITE_NOISE_NOT_SCALED_BY_SQRT_DT": (
        "The white noise has the same std at every sampling rate.",
        "A density is per square root of hertz: a sample that averages over dt has std "
        "noise_density / sqrt(dt), so faster sampling is noisier.",
    ),
    "WHITE_NOISE_TIMES_SQRT_DT": (
        "The white noise shrinks when sampling gets faster, where it should grow.",
        "Divide by sqrt(dt). Multiplying is for the bias, which gathers its steps up.",
    ),
    "WHITE_NOISE_OVER_DT": (
        "The white noise grows with 1/dt, without the square root.",
        "Variances add, not stds: the std is noise_density / sqrt(dt).",
    ),
    "WHITE_NOISE_FACTOR": (
        "The white noise depends on dt as it should and is off by a constant factor.",
        "The std of a sample is noise_density / sqrt(dt), with no other factor, from a standard normal.",
    ),
    "WHITE_NOISE_ACCUMULATES": (
        "The white noise of one sample is still there in the next ones: it is summed up.",
        "Only the bias is a running sum. White noise is drawn afresh for each sample.",
    ),
    "BIAS_CONSTANT": (
        "The bias stays where it starts.",
        "Add a step of std bias_random_walk * sqrt(dt) from each sample to the next.",
    ),
    "BIAS_NOT_RANDOM_WALK": (
        "The bias scatters around bias0 and never wanders off: its spread over ten samples is that over one.",
        "Each bias is the one before plus a step: bias0 + np.cumsum(steps), with a 0 in front.",
    ),
    "BIAS_NOT_SCALED_BY_SQRT_DT": (
        "The steps of the bias have the same std at every sampling rate.",
        "The variance of a walk grows with time: a step over dt has std bias_random_walk * sqrt(dt).",
    ),
    "BIAS_TIMES_DT": (
        "The steps of the bias are multiplied by dt, without the square root.",
        "Independent steps add in variance: the std of one is bias_random_walk * sqrt(dt).",
    ),
    "BIAS_OVER_SQRT_DT": (
        "The steps of the bias are divided by sqrt(dt), as the white noise is.",
        "Multiply: a longer step wanders further.",
    ),
    "BIAS_FACTOR": (
        "The steps of the bias depend on dt as they should and are off by a constant factor.",
        "The std of a step is bias_random_walk * sqrt(dt), with no other factor.",
    ),
    "BIAS_STARTS_LATE": (
        "The first bias has already taken a step.",
        "bias[0] is bias0 itself; N samples join N - 1 steps.",
    ),
    "BIAS0_IGNORED": (
        "The bias starts at zero, whatever bias0 is.",
        "bias[0] is bias0: add it to the running sum of the steps.",
    ),
    "BIAS_WALKS_TO_BIAS0": (
        "bias0 stands at the end: the walk is laid out backwards.",
        "bias[0] is bias0, and each step leads to the next sample: bias0 + np.cumsum(steps), a 0 in front.",
    ),
    "BIAS_CARRIED_OVER": (
        "The bias goes on where the call before ended: something is remembered between two calls.",
        "Start each call at the bias0 that it is given, and keep nothing outside the function.",
    ),
    "BIAS_NOT_ADDED": (
        "The bias is returned but is not on the measured rate.",
        "measured = true + bias + white noise.",
    ),
    "BIAS_SUBTRACTED": (
        "The bias enters the measured rate with the wrong sign.",
        "A sensor adds its bias: measured = true + bias + white noise.",
    ),
    "BIAS_OUT_OF_STEP": (
        "The bias that is returned is not the one on the measured rate, sample by sample.",
        "Use one array for both: measured[k] has bias[k] on it.",
    ),
    "SAME_DRAW_TWICE": (
        "White noise and bias steps are the same random numbers.",
        "Draw twice: rng.standard_normal(...) for the steps, and again for the white noise.",
    ),
    "GLOBAL_RANDOMNESS": (
        "The same generator state gives another result the second time: some of it comes from elsewhere.",
        "Draw only from the rng that is passed in: rng.standard_normal(n), not np.random.randn(n).",
    ),
    "GENERATOR_IGNORED": (
        "Different generators give the same noise.",
        "Draw from the rng that is passed in; do not make one with a fixed seed.",
    ),
    # -- fit_noise
    "DENSITY_NOT_SCALED_BY_SQRT_DT": (
        "What is returned as noise density is the std of a sample.",
        "A sample has std noise_density / sqrt(dt): multiply by sqrt(dt).",
    ),
    "DRIFT_COUNTED_AS_NOISE": (
        "The noise density holds the wandering of the bias as well.",
        "The std of the whole recording mixes both. Differences of neighbouring samples hardly see the walk: "
        "their variance is twice that of the white noise.",
    ),
    "DENSITY_FROM_DIFFERENCES": (
        "The noise density is too large by the square root of two.",
        "A difference of two samples has twice the variance of one: divide by two before the root.",
    ),
    "NOISE_COUNTED_AS_DRIFT": (
        "The random walk is far too large: the white noise is taken for steps of the bias.",
        "Between neighbouring samples the white noise drowns the walk. Average over ever longer blocks: "
        "the noise fades as 1/T, the walk grows as T/3.",
    ),
    "WALK_WITHOUT_THREE": (
        "The random walk comes out too small by the square root of three.",
        "A mean over T smooths the walk: its part of the Allan variance is K² T/3, not K² T.",
    ),
    "WALK_TOO_SMALL": (
        "The random walk comes out too small.",
        "Means over blocks hold N²/T of noise and K² T/3 of walk in their (Allan) variance, half the mean "
        "square of their differences: fit both terms. The walk shows in long blocks.",
    ),
    "WALK_TOO_LARGE": (
        "The random walk comes out too large.",
        "Means over blocks hold N²/T of noise and K² T/3 of walk in their (Allan) variance, half the mean "
        "square of their differences: fit both terms, or the noise is taken for walk.",
    ),
    "BIAS0_WITHOUT_SIGN": (
        "bias0 has the right size and is never negative.",
        "A bias has a sign: return the mean itself, not its absolute value.",
    ),
    "FIRST_SAMPLE_AS_BIAS": (
        "bias0 is a single sample, with all its white noise.",
        "Average the first stretch: long enough that the noise fades, short enough that the bias has not "
        "walked off: about sqrt(3) N/K seconds.",
    ),
    "WHOLE_MEAN_AS_BIAS": (
        "bias0 is the mean of the whole recording, and the bias has wandered off since the start.",
        "Average only the first stretch, about sqrt(3) N/K seconds of it.",
    ),
    # -- lidar
    "HEADING_IGNORED": (
        "Turning the robot does not turn the beams.",
        "angles are relative to the heading: a beam points along heading + angle.",
    ),
    "HEADING_SUBTRACTED": (
        "Turning the robot to the left turns the beams to the right.",
        "Add the heading to the angles: a beam points along heading + angle.",
    ),
    "BEAM_IN_DEGREES": (
        "The direction of a beam, or a part of it, is converted between degrees and radians.",
        "heading and angles are both in radians, and np.cos and np.sin take radians: convert nothing.",
    ),
    "BEAM_SIN_COS_SWAPPED": (
        "Sine and cosine of a beam's direction are swapped.",
        "A beam points along (cos, sin) of heading + angle.",
    ),
    "WALL_VECTOR_REVERSED": (
        "Walls are seen as if they began on the other side of the robot.",
        "Mind the order of each difference: from the robot to a wall it is the wall minus the robot.",
    ),
    "POSITION_IGNORED": (
        "Moving the robot does not change what it sees.",
        "Subtract the robot's position from the end points of the walls first.",
    ),
    "WALLS_NOT_READ": (
        "A wall that is moved nearer or further off still reads the same.",
        "Look at the segments of this very call, and keep none from an earlier one.",
    ),
    "WALLS_BEHIND_SEEN": (
        "A wall behind the robot is measured by the beam that points away from it.",
        "A beam goes one way: a hit counts only at a distance of zero or more.",
    ),
    "WALLS_ENDLESS": (
        "A beam that passes beside a wall is stopped by it, as if walls went on for ever.",
        "A hit counts only between the two ends: its share along the wall lies in [0, 1].",
    ),
    "NOT_THE_NEAREST": (
        "Of two walls in a row, the beam reports another than the nearest.",
        "Take the smallest distance of all the hits of a beam.",
    ),
    "BEYOND_RANGE": (
        "A wall further off than r_max is still measured.",
        "A hit beyond r_max is no hit: the reading is r_max exactly.",
    ),
    "NO_HIT_NOT_MAX": (
        "Where a beam hits nothing, the reading is not r_max.",
        "Start from r_max, and let only hits make it smaller.",
    ),
    "LIDAR_NOISE_ON_MAX": (
        "Readings without a hit carry noise.",
        "r_max is a flag that says nothing came back. Add noise to hits only.",
    ),
    "LIDAR_NOISE_MISSING": (
        "Two scans of one scene are exactly the same: there is no noise on the hits.",
        "Add sigma times a standard normal number to each hit.",
    ),
    "LIDAR_NOISE_SHARED": (
        "All beams of a scan are off by the same amount.",
        "Each beam needs a number of its own: rng.standard_normal(len(angles)).",
    ),
    "LIDAR_SIGMA_WRONG": (
        "The noise of the hits does not have the std sigma.",
        "Add sigma * rng.standard_normal(...), not its square, its root, or a share of the distance.",
    ),
    "NOISE_CUT_AT_MAX": (
        "A wall just within reach never reads more than r_max, whatever the noise.",
        "Decide without noise whether a beam hits, then add the noise and leave it: it may exceed r_max.",
    ),
    "NEGATIVE_RANGE": (
        "Close to a wall, noise makes some distances negative.",
        "No distance is below zero: np.maximum(..., 0.0) after the noise.",
    ),
    "PARALLEL_WALLS": (
        "A beam parallel to a wall gives a wrong distance.",
        "There the two directions have a cross product of zero: count it as no hit before you compare.",
    ),
}
