"""The mistakes that the checks of ``engine-comparison`` recognise, in words.

Each code says what the submission looks like and what to change. ``probes.py`` finds which one it is.
"""

from __future__ import annotations

from course.grading.kit import Diagnosis

#: code: (what it looks like, what to change)
WORDS: dict[str, tuple[str, str]] = {
    # -- order
    "ORDER_AGAINST_UNDAMPED": (
        "It is right where there is no damping and near zero where there is: the engine was compared with a "
        "spring that never fades, and that difference does not shrink with the step.",
        "Compare the engine with itself: the same time with n, 2n and 4n steps. The two differences shrink "
        "by two to the power of the order, whatever the engine's own damping.",
    ),
    "ORDER_LOCAL": (
        "It is one too high everywhere: that is the order of a single step.",
        "Run for one fixed time, so that half the step means twice as many steps, and compare the ends.",
    ),
    "ORDER_AT_TURNING_POINT": (
        "Engines look one or two orders better than they are: the runs start or end where the leading error "
        "happens to vanish, at rest or after a whole half-turn.",
        "Start with a position and a velocity, end at an ordinary moment, and compare both halves.",
    ),
    "ORDER_WITHOUT_LOG": (
        "It is two to the power of the order: the ratio of the two differences as it is.",
        "Take the logarithm to base two of that ratio, math.log2, and round it.",
    ),
    "ORDER_OTHER_LOG": (
        "It is the logarithm of the ratio to another base than two.",
        "Each halving of the step divides the difference by two to the power of the order: take math.log2.",
    ),
    "ORDER_IN_ROUNDING": (
        "Only the accurate engines are wrong: at steps this small their differences are mere rounding.",
        "Take larger steps, such as a sixteenth to a quarter of 1/omega: the differences must stay far above "
        "1e-12.",
    ),
    "ORDER_ASSUMED": (
        "It is the same for every engine.",
        "Measure: run the spring for one fixed time with n, 2n and 4n steps and compare the ends.",
    ),
    "ORDER_SIGN": (
        "It has the right size and the wrong sign.",
        "The coarser pair differs more: divide its difference by the finer pair's before the logarithm.",
    ),
    "ORDER_NOT_WHOLE": (
        "The measured slope is reported as it came.",
        "The order is a whole number: round the slope, int(round(...)).",
    ),
    # -- symplectic
    "SYMPLECTIC_INVERTED": (
        "Every answer is the opposite of the right one.",
        "Symplectic means that the determinant is one: return abs(det - 1) < 1e-6.",
    ),
    "SYMPLECTIC_STEP_TOO_SMALL": (
        "Engines that lose a little area at every step pass: the step is so small that the loss hides below "
        "the threshold.",
        "Take the one step at h = 0.5/omega, as the README says.",
    ),
    "STABLE_TAKEN_FOR_SYMPLECTIC": (
        "Engines that shrink the state pass too: bounded is not the same as keeping area.",
        "Compare the determinant with one from both sides: a determinant below one is damping.",
    ),
    "SYMPLECTIC_NEVER": (
        "No engine passes, not even those that keep area exactly.",
        "Energy need not be the same after a step. Build the matrix of one step from two runs with n = 1 and "
        "look at its determinant.",
    ),
    # -- damping
    "DAMPING_AT_DT": (
        "It is what the engine does at its own dt: the rate there still carries an error of the step.",
        "Use a much smaller step, or measure at h and h/2 and extrapolate: the limit h -> 0 is asked for.",
    ),
    "DAMPING_PER_STEP": (
        "It is the loss per step, not per second.",
        "Divide the change of ln|v| by the time that passed, n times h.",
    ),
    "DAMPING_OF_ENERGY": (
        "It is twice too large: the energy goes with the square of the speed and fades twice as fast.",
        "Take the logarithm of the speed, not of its square.",
    ),
    "DAMPING_NOT_LOG": (
        "It is the share of the speed that is lost, divided by the time: that is less than the rate, and the "
        "less the longer the run.",
        "The speed falls as exp(-c t): take -ln(v/v0) / t.",
    ),
    "DAMPING_OF_ENVELOPE": (
        "It is half of what it should be: on a spring the swing fades at half the rate.",
        'Use the scene "free", where nothing acts but the damping.',
    ),
    "DAMPING_SIGN": (
        "It has the right size and the wrong sign.",
        "The rate is -d ln|v|/dt: a body that slows down has a positive damping.",
    ),
    "DAMPING_AS_FORCE": (
        "It is the rate times the mass.",
        "The report wants the rate of the velocity itself, 1/s: leave the mass out.",
    ),
    "DAMPING_ASSUMED": (
        "It is zero for every engine, also for those that slow a free body down.",
        "Give a free body a velocity and no force, and look at it later.",
    ),
    # -- stability
    "LIMIT_FROM_ABOVE": (
        "Where stability is lost and found again it reports the later end of it: the search came from above "
        "or jumped across.",
        "Walk up from 0.05/omega in steps of half of 1/omega, stop at the first that is unstable, and bisect "
        "only between that one and the one before.",
    ),
    "LIMIT_ASSUMED": (
        "It is two over omega for every engine: that is the limit of one family of methods only.",
        "Build the matrix of one step at each h from two runs and look at its eigenvalues.",
    ),
    "RETURNS_Z": (
        "It is the product of step and omega.",
        "Divide by omega: the answer is a time in seconds.",
    ),
    "NO_INFINITY": (
        "An engine that never fails gets the end of the search as its answer.",
        "Return math.inf where nothing fails in the range that the README gives.",
    ),
    "NO_ZERO": (
        "An engine that already grows at the smallest step gets a positive limit. It grows so slowly that a "
        "run of a few hundred steps does not show it.",
        "Look at the eigenvalues of one step, not at many steps, and return 0.0 if h = 0.05/omega fails.",
    ),
    "STABLE_BY_DETERMINANT": (
        "Engines that keep area are called stable at any step: the determinant is the product of the "
        "eigenvalues, and one may be large while the other is small.",
        "Look at the largest modulus alone: max(abs(np.linalg.eigvals(M))).",
    ),
    "TOLERANCE_TOO_TIGHT": (
        "Engines whose spectral radius is one are called unstable: rounding takes it above one by a hair.",
        "Unstable means above 1 + 1e-8.",
    ),
    "LIMIT_COARSE": (
        "It is close, and off by more than the report allows.",
        "Once two neighbours differ, one stable and the next not, bisect between them.",
    ),
    # -- friction
    "ANISOTROPY_INVERTED": (
        "It is one over the right ratio.",
        "The diagonal goes on top: F(45 degrees) / F(0 degrees).",
    ),
    "DIAGONAL_COMPONENT": (
        "Its force along the diagonal is the size of one component, not of the force.",
        "Push with (F cos 45°, F sin 45°, 0) and report F; pushing with (F, F, 0) pushes with 1.41 F.",
    ),
    "ANISOTROPY_ASSUMED": (
        "It is one for every engine.",
        "Push the settled body along x and along the diagonal, and bisect the least force of each.",
    ),
    "CREEP_TAKEN_FOR_SLIP": (
        "Only engines whose bodies creep are wrong: they move a little however gently they are pushed.",
        "A body slides when it gets faster than 0.01 m/s, not when it moves at all.",
    ),
    "NOT_SETTLED": (
        "Only engines with soft contact are wrong: the body was pushed while it was still sinking in, "
        "when the floor did not yet carry its weight.",
        "Let it come to rest first, then start each push from where it lies.",
    ),
    # -- penetration
    "PENETRATION_SIGN": (
        "A body that sinks in gets zero or a negative depth, or one that hovers gets a positive one: the "
        "difference is taken the wrong way round.",
        "Depth is radius - z: the centre of a body that sinks in lies lower than its radius.",
    ),
    "PENETRATION_NEGATIVE": (
        "An engine that keeps bodies at a distance gets a negative depth.",
        "The report wants max(0, radius - z).",
    ),
    "PENETRATION_ABSOLUTE": (
        "An engine that keeps bodies at a distance gets a depth.",
        "Hovering is not sinking: max(0, radius - z), not abs(radius - z).",
    ),
    "PENETRATION_TOO_EARLY": (
        "It is the deepest point of the landing, before the body came to rest.",
        "Wait five seconds after touching and take the last sample.",
    ),
    "PENETRATION_HEIGHT": (
        "It is the height of the centre.",
        "Subtract it from the radius, which info() gives.",
    ),
    # -- restitution
    "RESTITUTION_SIGN": (
        "It has the right size and is negative.",
        "The velocity turns round; the report wants the ratio of the speeds.",
    ),
    "RESTITUTION_SQUARED": (
        "It is the square of the right ratio, that of the energies.",
        "Divide the speed after by the speed before, nothing squared.",
    ),
    "RESTITUTION_OTHER_SPEED": (
        "Engines that do not bounce slow impacts get zero: the body arrived at less than 2 m/s.",
        "Let it meet the wall at 2 m/s; the coefficient may depend on the speed.",
    ),
    "RESTITUTION_WITH_DRAG": (
        "It is too low where the engine slows bodies down anyway: the loss on the way is counted as the "
        "wall's.",
        "Start close to the wall and compare the last sample before the hit with the first one after it.",
    ),
    # -- tunnelling
    "TUNNEL_ONE_START": (
        "It is too high, and for each speed only one start was tried: whether a body is seen depends on "
        "where its samples happen to fall.",
        "Try many starts, spread evenly over [-1 - v dt, -1], and count a speed as safe only if none gets "
        "through.",
    ),
    "TUNNEL_FEW_STARTS": (
        "It is somewhat too high: between the starts that were tried there is one that gets through.",
        "Try more of them (with k starts a gap up to one part in k stays unseen), or look where the samples "
        "fall and shift the start so that one lies just short of the wall.",
    ),
    "TUNNEL_NEVER_SEEN": (
        "It says that nothing gets through where bodies do.",
        "Is every run long enough to bring the body past the wall, 2 m and more? Do you look on which side "
        "it ends, try speeds up to 200 m/s, and many starts for each?",
    ),
    "TUNNEL_NO_INFINITY": (
        "An engine through which nothing passes gets the end of the search as its answer.",
        "Return math.inf where no start gets through up to the speed that the README names.",
    ),
    "TUNNEL_BY_GEOMETRY": (
        "It is the same formula of radius, thickness and dt for every engine.",
        "Engines look for contact in different ways; shoot bodies at the wall and see which get through.",
    ),
    "TUNNEL_WITHOUT_RADIUS": (
        "It is the wall's thickness over dt for every engine.",
        "Engines look for contact in different ways, and the body has a size: shoot and see.",
    ),
    # -- determinism
    "DETERMINISM_ONE_RUN": (
        "Every engine is called deterministic, and no run was ever repeated.",
        "Run the same experiment twice and compare every number.",
    ),
    "DETERMINISM_TOLERANCE": (
        "Every engine is called deterministic, although runs were repeated: the comparison forgives small "
        "differences.",
        "Bit for bit means np.array_equal, not np.allclose: the differences are a million million times "
        "smaller than the values.",
    ),
    "DETERMINISM_AT_REST": (
        "Runs were repeated, but only of a body at rest: nothing times a jitter is still nothing.",
        "Repeat a run in which something moves.",
    ),
    "DETERMINISM_INVERTED": (
        "Every answer is the opposite of the right one.",
        "True means that the two runs agree.",
    ),
    "DETERMINISM_OTHER_RUN": (
        "No engine is called deterministic, not even those that repeat themselves exactly.",
        "Compare two runs with the very same arguments.",
    ),
    # -- the report
    "NOT_MEASURED": (
        "",
        "Measure it as the README says, and put the value under this key.",
    ),
    # -- choosing
    "IGNORES_MISSING": (
        "An engine whose report lacks a key, or has None there, counts as if it met the requirement.",
        "What was not measured was not met: test `report.get(key) is None` first and call it a failure.",
    ),
    "NEVER_CHOOSES": (
        "It returns None every time, whatever is asked and whatever the engines are called.",
        "Return the name of the cheapest that fits. Does a return inside the loop come too early, or is only "
        "one engine looked at?",
    ),
    "COST_BEFORE_REQUIREMENTS": (
        "It takes the cheapest of all engines first and looks at the requirements afterwards.",
        "Filter first: keep the engines that meet every requirement. Then take the cheapest of those.",
    ),
    "REQUIREMENTS_IGNORED": (
        "It takes the cheapest engine whatever is required.",
        "Keep only the engines that meet every requirement, then take the cheapest of those.",
    ),
    "COST_IGNORED": (
        "Of the engines that fit it takes one that is not the cheapest.",
        'Take the one with the least cost: min(fitting, key=lambda name: reports[name]["cost"]).',
    ),
    "COST_REVERSED": (
        "Of the engines that fit it takes the dearest.",
        "Take the one with the least cost.",
    ),
    "ANY_INSTEAD_OF_ALL": (
        "It takes an engine that meets some of the requirements and not all.",
        "Hard requirements are no wish list: all of them must be met.",
    ),
    "FIRST_REQUIREMENT_ONLY": (
        "It looks at one of the requirements and not at the rest.",
        "Does a return inside the loop come before all of them were looked at? All must be met.",
    ),
    "STRICT_COMPARISON": (
        "An engine that meets a limit exactly is refused.",
        '"<=" and ">=" include equality.',
    ),
    "OPERATOR_CONFUSED": (
        "It reads an operator the wrong way round or ignores which one is asked for.",
        '"<=" asks that the report\'s value is at most the required one, ">=" at least, "==" equal.',
    ),
    "NOTHING_FITS": (
        "It names an engine, or something else, although none fits.",
        "Return None if no engine meets every requirement.",
    ),
    "DEPENDS_ON_NAMES": (
        "The same reports under other names give another choice.",
        "Look at the reports only; a name is no measurement.",
    ),
    "DEPENDS_ON_ORDER": (
        "The same reports in another order give another choice.",
        "Compare the costs of all engines that fit, wherever they stand.",
    ),
    "NOT_A_NAME": (
        "It does not return one of the names it was given.",
        "Return the key of the chosen report, or None.",
    ),
    "MUTATES_INPUT": (
        "The caller still needs the reports and requirements as they were.",
        "Build new lists instead of removing from the given ones.",
    ),
    # -- facts
    "PAIR_MISSING": (
        "Some engine has no entry for some field.",
        "There are four engines and five fields: twenty entries.",
    ),
    "PAIR_TWICE": (
        "Some engine has two entries for one field.",
        "Keep one entry for each pair of engine and field.",
    ),
    "STALE_LICENCE": (
        "An engine that has become free is listed with the licence it once had.",
        "MuJoCo and PhysX changed hands and licences: read the licence file in the repository of today.",
    ),
    "NOT_SPDX": (
        "A licence is named in everyday words.",
        "Look its identifier up in the SPDX list (spdx.org/licenses); two that may be chosen from are joined "
        "by OR.",
    ),
    "OTHER_LICENCE": (
        "A licence is named by a proper identifier, and it is not the one of this engine, or not one of "
        "those it may be used under.",
        "Open the licence file in the engine's repository: version and kind both count, and where there are "
        "two files either will do.",
    ),
    "SOURCE_NOT_A_URL": (
        "A source is no address that somebody could open.",
        "Give the page you read, beginning with https://.",
    ),
    "NOT_A_DATE": (
        "A date is no calendar date of the form YYYY-MM-DD.",
        "Write the day you looked it up, such as 2026-03-14.",
    ),
    "DATE_BEFORE_FACT": (
        "A fact is dated before it became true.",
        "as_of is the day on which you found the fact to hold.",
    ),
    "DATE_AHEAD": (
        "A fact is dated in the future.",
        "as_of is the day on which you found the fact to hold.",
    ),
    "STEP_OF_A_HABIT": (
        "An engine that has no step of its own is given one: it takes whatever step its caller passes.",
        "Report None for an engine whose step function asks for the step and has no default.",
    ),
    "INTEGRATOR_BY_NAME": (
        "An integrator that is called Euler is taken for explicit Euler.",
        "The names differ from house to house: see which half of the state is updated first.",
    ),
    "GAZEBO_SIM_USES_DART": (
        "Today's Gazebo is listed as a user of ODE.",
        "Gazebo Classic used ODE; Gazebo Sim uses DART unless told otherwise. Name the one you mean.",
    ),
}


def named(code: str) -> Diagnosis:
    """The diagnosis of that code."""
    looks_like, advice = WORDS[code]
    return Diagnosis(code, looks_like, advice)
