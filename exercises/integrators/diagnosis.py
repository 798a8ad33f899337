"""The mistakes that the checks of ``integrators`` recognise, in words.

Each code says what the submission looks like and what to change. ``probes.py`` finds which one it is.
"""

from __future__ import annotations

from course.grading.kit import Diagnosis, Divergence

_BY_HAND = (
    "Take one step by hand from the README's example and compare q and v separately: sign, factor, and "
    "whether old or new values go in."
)

#: code: (what it looks like, what to change)
WORDS: dict[str, tuple[str, str]] = {
    # -- steps: one method in another's place
    "EULER_IS_SEMI_IMPLICIT": (
        "It takes exactly the steps of semi-implicit Euler: one half of the state is already updated "
        "when the other half is computed.",
        "Explicit Euler uses only the old state. Compute the acceleration from the old q and v, then "
        "both new values, and assign neither before both are computed: q + h*v with the old v, not "
        "v_next.",
    ),
    "SEMI_IMPLICIT_IS_EULER": (
        "It takes exactly the steps of explicit Euler: both halves of the state are moved with old values.",
        "Update the velocity first, then move the position with the new velocity: q + h*v_next, not q + h*v.",
    ),
    "VERLET_IS_EULER": (
        "It takes exactly the steps of explicit Euler.",
        "Verlet takes half a kick, a whole drift with that half-kicked velocity, and half a kick more "
        "with the acceleration at the new position.",
    ),
    "VERLET_IS_SEMI_IMPLICIT": (
        "It takes exactly the steps of semi-implicit Euler: a whole kick on one side of the drift.",
        "Split the kick: half of it before the drift with the old acceleration, half after it with the "
        "new one.",
    ),
    "RK4_IS_EULER": (
        "It takes exactly the steps of explicit Euler: only the first slope is used.",
        "Evaluate four slopes, the second and third at the middle and the fourth at the end of the "
        "step, and combine them with weights one sixth, one third, one third, one sixth.",
    ),
    "RK4_IS_MIDPOINT": (
        "It takes exactly the steps of the midpoint rule: of the slopes only the second counts.",
        "Go on: a third slope at the middle, reached with the second, and a fourth at the end, reached "
        "with the third; then weights one sixth, one third, one third, one sixth.",
    ),
    "RK4_IS_HEUN": (
        "It takes exactly the steps of Heun's method: the average of a slope at each end.",
        "Two slopes give order two. Add two at the middle of the step and weight the four as Simpson's "
        "rule does.",
    ),
    "RK4_IS_VERLET": (
        "It takes exactly the steps of velocity Verlet.",
        "Runge-Kutta needs four slopes of the whole state (dq = v and dv = accel), each from the one before.",
    ),
    # -- steps: pieces that are wrong
    "RETURNS_SWAPPED": (
        "It returns the right two values in the wrong order.",
        "Return (q_next, v_next): the position first.",
    ),
    "RETURNS_INCREMENT": (
        "It returns how much q and v change instead of what they become.",
        "Add the changes to the old state: return q + dq, v + dv.",
    ),
    "STATE_NOT_ADVANCED": (
        "It returns the state it was given.",
        "Return the new values; check that the names in the return statement are the ones you computed.",
    ),
    "WRONG_SIGN": (
        "It behaves as if the acceleration had the opposite sign.",
        "accel already points the way it acts: add h times it, whatever the force is.",
    ),
    "STEP_SIZE_MISSING": (
        "It moves as far as a step of one second would, whatever h is.",
        "Multiply every slope by h (or by its share of h) before adding it.",
    ),
    "STAGE_TIMES_FROZEN": (
        "It evaluates accel at the time of the start of the step where the formula asks for a later time."
        " No problem without a clock shows this, so it may look right on a spring.",
        "Give accel the time that belongs to the position you give it: t + h/2 for a state half a step "
        "on, t + h for one a whole step on.",
    ),
    "STAGE_TIMES_AHEAD": (
        "It evaluates accel at the old state but at the time of the end of the step.",
        "Give accel the time that belongs to the position you give it: t for q, t + h for q_next.",
    ),
    "AVERAGED_VELOCITY": (
        "It moves the position with the mean of the old and the new velocity.",
        "Move the position with the new velocity alone. The mean looks more accurate, but the map is no "
        "longer symplectic and the energy drifts.",
    ),
    "USES_OLD_ACCELERATION": (
        "The position is right, but the velocity is kicked with the old acceleration only.",
        "Evaluate accel again at (t + h, q_next) and give the velocity half a kick of each: v + "
        "h/2*(a_old + a_new).",
    ),
    "USES_NEW_ACCELERATION": (
        "The position is right, but the velocity is kicked with the new acceleration only.",
        "Keep the acceleration from the start of the step too: v + h/2*(a_old + a_new).",
    ),
    "HALF_MISSING": (
        "The position is moved by h*v + h**2*a: the square term lacks its factor one half.",
        "Constant acceleration moves a body by h*v + h**2/2*a. Put the 1/2 in, or drift with the half-"
        "kicked velocity v + h/2*a.",
    ),
    "QUADRATIC_TERM_MISSING": (
        "The position is moved with the old velocity alone.",
        "Drift with the velocity after the first half kick: q + h*(v + h/2*a).",
    ),
    "POSITION_TERM_SUBTRACTED": (
        "In the position, the square term with the acceleration is subtracted.",
        "Constant acceleration moves a body by h*v + h**2/2*a. accel already points the way it acts, so "
        "the term is added.",
    ),
    "KICK_SUBTRACTED": (
        "In the velocity, an acceleration is subtracted.",
        "accel already points the way it acts: both half kicks are added, v + h/2*(a_old + a_new).",
    ),
    "KICKS_TOO_LARGE": (
        "Each of the two kicks takes the whole step, so the velocity gets twice what it should.",
        "There are two kicks a step: each takes h/2.",
    ),
    "SECOND_KICK_MISSING": (
        "The velocity gets the first half kick and not the second.",
        "After the drift, evaluate accel at (t + h, q_next) and add the other half kick.",
    ),
    "EQUAL_WEIGHTS": (
        "The four slopes are averaged with equal weights.",
        "The two middle slopes count double: (k1 + 2*k2 + 2*k3 + k4)/6.",
    ),
    "WEIGHTS_MISPLACED": (
        "The outer slopes count double instead of the middle ones.",
        "The two middle slopes count double: (k1 + 2*k2 + 2*k3 + k4)/6.",
    ),
    "WEIGHTS_DO_NOT_ADD_UP": (
        "The weights of the four slopes do not add up to one, so even a constant slope is followed wrongly.",
        "One, two, two and one make six: divide the weighted sum by 6, once.",
    ),
    "HALF_STEP_MISSING": (
        "The middle slopes are taken a whole step on instead of half a step.",
        "The second and third slope belong to t + h/2, reached with h/2 times the slope before.",
    ),
    "LAST_STAGE_AT_HALF": (
        "The fourth slope is taken half a step on.",
        "The fourth slope belongs to the end of the step: t + h, reached with h times the third slope.",
    ),
    "STAGES_NOT_CHAINED": (
        "A later stage starts from a slope other than the one just before it.",
        "Each stage uses the slope before it: the second uses k1, the third k2, the fourth k3.",
    ),
    "STAGE_VELOCITY_IGNORED": (
        "accel always gets the velocity of the start of the step. A spring does not notice, damping does.",
        "Give accel the velocity of the stage as well: each stage has a position and a velocity of its own.",
    ),
    "STAGE_POSITION_IGNORED": (
        "accel always gets the position of the start of the step.",
        "Give accel the position of the stage: each stage has a position and a velocity of its own.",
    ),
    "POSITION_SLOPES_FROZEN": (
        "The position moves with the velocity of the start in every stage.",
        "Position and velocity are advanced together: the slope of q in a stage is that stage's velocity,"
        " not v.",
    ),
    "DOES_NOT_CONVERGE": (
        "Smaller steps do not bring it closer to the true motion, so a term of the formula itself is wrong.",
        "Look for a sign, a factor 1/2 or an h that is missing: take one step by hand from the README's "
        "example and compare q and v separately.",
    ),
    "ORDER_TOO_LOW": (
        "It does converge, but slower than this method: most of the formula is right and one part of it "
        "is only roughly so.",
        "Compare it with the formula term by term: sign, factor and power of h, then where and when each "
        "acceleration is evaluated.",
    ),
    "ENERGY_GROWS": (
        "It puts more energy into a spring than this method does.",
        _BY_HAND,
    ),
    "ENERGY_GROWS_TOO_LITTLE": (
        "It puts less energy into a spring than this method does.",
        _BY_HAND,
    ),
    "ENERGY_FADES": (
        "It takes more energy out of a spring than this method does.",
        _BY_HAND,
    ),
    "ENERGY_FADES_TOO_LITTLE": (
        "It takes less energy out of a spring than this method does.",
        _BY_HAND,
    ),
    "ENERGY_SWINGS_TOO_FAR": (
        "The energy of a spring gets further from its first value than with this method.",
        "Look at which values are old and which are new when the position moves and when the velocity does.",
    ),
    "ENERGY_SWINGS_TOO_LITTLE": (
        "The energy of a spring stays nearer to its first value than with this method.",
        "Look at which values are old and which are new when the position moves and when the velocity does.",
    ),
    "EXTRA_EVALUATIONS": (
        "It calls accel more often than this method needs.",
        "Evaluate once per stage, keep the value in a variable and use that: real forces are expensive.",
    ),
    "MISSING_EVALUATIONS": (
        "It calls accel less often than this method needs, so something is reused that has changed.",
        "Evaluate accel afresh for each stage, at that stage's own time, position and velocity.",
    ),
    "ACCEL_ARGUMENTS_MIXED": (
        "It calls accel with the time, the position or the velocity in another one's place.",
        "Call accel(t, q, v): the time first, then the position, then the velocity.",
    ),
    "STALE_CACHE": (
        "The same call gives another result after a call in between: it remembers something that no "
        "longer holds.",
        "A step may keep an acceleration only together with the accel, t and q it belongs to, and must "
        "evaluate again when any of them differs.",
    ),
    # -- any function
    "MUTATES_INPUT": (
        "The caller still needs the old numbers.",
        "Write q = q + ..., which makes a new array, instead of q += ... or q[:] = ..., which change "
        "the old one.",
    ),
    "RETURNS_ARGUMENT": (
        "Changing the result later would change the caller's state too.",
        "Return new arrays: q + ... makes one, and q.copy() does where nothing is added.",
    ),
    "INTEGER_STATE": (
        "It computes in whole numbers there, and the fractions are lost.",
        "Make float arrays before you store into them: np.zeros(...) is float, np.zeros_like(q0) takes "
        "q0's type.",
    ),
    # -- integrate
    "TRUNCATED_STEP_COUNT": (
        "The number of steps is cut off instead of rounded: in floating point t_end/h may fall just below"
        " a whole number.",
        "Use round(t_end / h), not int(...) and not //.",
    ),
    "STEP_COUNT_ROUNDED_UP": (
        "The number of steps is rounded up: in floating point t_end/h may fall just above a whole number.",
        "Use round(t_end / h), not math.ceil(...).",
    ),
    "TIME_ACCUMULATES": (
        "The loop runs until a running sum of h reaches t_end. The sum is not exact, so for some steps it"
        " falls just short and the loop takes one step too many.",
        "Fix the number of steps first, n = round(t_end / h), loop over range(n), and compute t as i*h.",
    ),
    "OFF_BY_ONE_SAMPLE": (
        "It is off by one for every duration: n steps join n + 1 states.",
        "Record the initial state before the loop and one state after each of the n steps.",
    ),
    "TRUNCATED_AND_SHORT": (
        "Two things at once: the number of steps is cut off instead of rounded, and there is one sample "
        "less than those steps join.",
        "Use n = round(t_end / h), not int(...) and not //; then record the initial state before the loop "
        "and one state after each of the n steps.",
    ),
    "HISTORIES_SWAPPED": (
        "The states are right, but the velocities come where the positions belong, and the other way round.",
        "Return (t, q, v): the positions before the velocities, and each in its own array.",
    ),
    "HISTORIES_IDENTICAL": (
        "The positions and the velocities that it returns are the same numbers.",
        "Give each an array of its own, for v = q only gives one array a second name; fill each with its "
        "half of the state, and return both.",
    ),
    "INITIAL_STATE_WRONG": (
        "The first row is not the initial state.",
        "Row 0 holds q0 in the positions and v0 in the velocities, as they were before any step.",
    ),
    "TIMES_START_LATE": (
        "The first row holds the initial state, but the times begin one step later.",
        "Row i belongs to time i*h, so the initial state is at time 0.",
    ),
    "INITIAL_STATE_MISSING": (
        "The first sample is not the initial state.",
        "Store q0 and v0 at time 0 before the first step.",
    ),
    "LAST_STEP_MISSING": (
        "The last row was never filled.",
        "n steps fill the rows 1 to n: loop over range(n) and write row i + 1.",
    ),
    "STATE_NOT_CARRIED": (
        "Every step starts from the initial state again.",
        "Pass the state that the step before returned: row i goes in, row i + 1 comes out.",
    ),
    "VELOCITY_NOT_CARRIED": (
        "The position is carried from step to step and the velocity is not.",
        "Pass both halves of the state that the step before returned.",
    ),
    "TIME_NOT_PASSED": (
        "Every step is told that it starts at the same time. A spring does not notice, a driven system does.",
        "Call step(accel, i * h, q, v, h): the time at which this very step starts.",
    ),
    "TIME_AHEAD": (
        "Each step is told the time at which it ends.",
        "Call step(accel, i * h, q, v, h): the time at which this very step starts.",
    ),
    "DURATION_NOT_CHECKED": (
        "It integrates to some other end without a word.",
        "Compare t_end / h with the whole number n next to it and raise ValueError if they differ by "
        "more than 1e-6.",
    ),
    "REFUSES_DIVISIBLE": (
        "In floating point the quotient misses the whole number by a rounding error, and t_end % h may "
        "be nearly h instead of 0.",
        "Allow for rounding: raise only if abs(t_end / h - round(t_end / h)) > 1e-6.",
    ),
    # -- observed_order
    "ORDER_SLOPE_INVERTED": (
        "It is the slope of log h over log error: the two are swapped.",
        "The order is d log(error) / d log(h): h is the abscissa (first argument of np.polyfit), error "
        "the ordinate.",
    ),
    "ORDER_SIGN_FLIPPED": (
        "The order has the wrong sign.",
        "Errors shrink when h shrinks, so a converging method has a positive slope: pair each h with its "
        "error.",
    ),
    "LOGARITHM_MISSING": (
        "The slope is taken with the plain numbers on at least one axis.",
        "error = C * h**p is a straight line only with logarithms on both axes: take np.log of hs and of "
        "errors.",
    ),
    "LOGARITHMS_MIXED": (
        "The two axes use logarithms of different bases.",
        "Use one logarithm for both; which one does not matter, it cancels.",
    ),
    "ORDER_FROM_ENDS": (
        "Only two of the points are used, and the others are ignored.",
        "Fit all points by least squares; np.polyfit with degree 1 does it, and a sum over centred logs too.",
    ),
    "ORDER_THROUGH_ORIGIN": (
        "The line is forced through the origin.",
        "error = C * h**p has an intercept, log C: subtract the mean of each axis first, or fit two "
        "coefficients.",
    ),
    "ORDER_MEAN_OF_PAIRS": (
        "It averages the slopes of neighbouring points instead of fitting one line to all.",
        "Fit one line by least squares: noise in the middle points then averages out.",
    ),
    "ORDER_ROUNDED": (
        "The result is rounded to a whole number.",
        "Return the slope itself as a float: whether it is near a whole number is what the reader wants "
        "to see.",
    ),
    # -- max_stable_step
    "RETURNS_Z": (
        "It returns the product h * omega at the limit, not the step itself.",
        "Divide by omega: the answer is a time in seconds.",
    ),
    "ASSUMES_ITS_LIMIT": (
        "It gives the same h * omega for every step it is handed.",
        "Call the given step on the two unit states to get its matrix, and look at the eigenvalues of that.",
    ),
    "STABILITY_BY_NORM": (
        "It asks that one step never enlarges the state (a norm of the matrix). Many steps can stay "
        "bounded although a single one enlarges.",
        "Use the eigenvalues: max(abs(np.linalg.eigvals(M))).",
    ),
    "STABILITY_BY_DETERMINANT": (
        "It looks at the determinant, which is the product of the eigenvalues: one can be large while the"
        " other is small.",
        "Look at the largest modulus alone: max(abs(np.linalg.eigvals(M))).",
    ),
    "EIGENVALUES_WITHOUT_MODULUS": (
        "It looks at real parts or signed values of the eigenvalues, so one at -1.1 or off the real axis "
        "passes.",
        "Take the modulus of each before the maximum: max(abs(np.linalg.eigvals(M))).",
    ),
    "LARGEST_STABLE_STEP": (
        "It finds a later range of stable steps beyond an unstable one.",
        "Walk up from 0.05/omega in small steps and stop at the first that fails, then bisect inside that"
        " one interval only.",
    ),
    "TOLERANCE_TOO_TIGHT": (
        "It calls a map unstable whose spectral radius exceeds one by no more than rounding.",
        "Allow what the README allows: unstable means above 1 + 1e-8.",
    ),
    "NO_ZERO": (
        "It returns a positive step for a map that already fails at the smallest step of the search.",
        "Test h = 0.05/omega first and return 0.0 if it fails.",
    ),
    "NO_INFINITY": (
        "It returns the end of its search for a map that never fails there.",
        "Return math.inf when nothing below 10/omega fails.",
    ),
    "SEARCH_TOO_COARSE": (
        "It is close, and off by more than the grid may leave.",
        "Once two neighbouring steps differ, one stable and the next not, bisect between them.",
    ),
}


def named(code: str, divergence: Divergence | None = None) -> Diagnosis:
    """The diagnosis of that code."""
    looks_like, advice = WORDS[code]
    return Diagnosis(code, looks_like, advice, divergence)
