"""The mistakes that the checks of ``collisions`` recognise, in words.

Each code says what the submission looks like and what to change. ``probes.py`` finds which one it is.
"""

from __future__ import annotations

from course.grading.kit import Diagnosis, Divergence

#: code: (what it looks like, what to change)
WORDS: dict[str, tuple[str, str]] = {
    # -- detection
    "NORMAL_REVERSED": (
        "The normal is taken to point the other way, from b to a (or into the solid).",
        "The normal points from a to b: (xb - xa) over its length. A plane's normal is the one you are given."
        " Bodies approach where (va - vb) . n is positive.",
    ),
    "NORMAL_NOT_UNIT": (
        "The normal is the whole vector between the centres, not a unit vector.",
        "Divide it by its length. Impulses along a longer normal would be too large by that length.",
    ),
    "NORMAL_UNDEFINED": (
        "Where the centres coincide, the vector between them has no direction, and dividing by its length"
        " gives nan.",
        "Test for a distance of zero first and return any unit vector there, such as the first axis.",
    ),
    "DEPTH_SIGN_FLIPPED": (
        "It returns the gap instead of the depth: positive apart and negative when they overlap.",
        "depth = ra + rb - distance, or r - height: positive inside, negative apart.",
    ),
    "DEPTH_CLAMPED": (
        "The depth is cut off at zero, so it no longer says how far apart two separate bodies are.",
        "Return the depth with its sign. A simulator needs the negative values to know when to look again.",
    ),
    "DEPTH_UNSIGNED": (
        "The depth lost its sign, so bodies apart and bodies that overlap look alike.",
        "Leave the abs() out. A distance without a sign cannot tell inside from outside.",
    ),
    "TOUCHING_INVERTED": (
        "touching is True exactly where it should be False.",
        "They touch where the depth is zero or more.",
    ),
    "DISTANCE_SQUARED": (
        "A squared distance is compared with a length.",
        "Take the square root before you subtract; the squares may be compared only with (ra + rb)**2.",
    ),
    "RADIUS_IGNORED": (
        "The bodies are treated as points: their radii play no part.",
        "Surfaces touch while the centres are still ra + rb apart (or r from a wall). A point never hits "
        "a point.",
    ),
    "ONE_RADIUS_ONLY": (
        "Only one of the two radii is used.",
        "The centres are ra + rb apart at contact: both bodies have a size.",
    ),
    "RADIUS_ADDED_TWICE": (
        "The radius counts twice.",
        "A sphere reaches r below its centre: depth = r - height of the centre above the plane.",
    ),
    "DISTANCE_UNSIGNED": (
        "The height above the plane lost its sign: a centre on the wrong side counts as outside.",
        "Leave the abs() out: (x - point) . normal is negative inside the solid, and the depth then "
        "exceeds r.",
    ),
    "PLANE_POINT_IGNORED": (
        "The plane is taken to go through the origin.",
        "Measure from a point of the plane: (x - point) . normal.",
    ),
    "PLANE_ASSUMED_LEVEL": (
        "Only the last coordinate is used, as if every plane were a level floor.",
        "The height above a tilted plane is the dot product (x - point) . normal.",
    ),
    "DISTANCE_TO_POINT": (
        "It measures the distance to the given point of the plane, and not to the plane.",
        "Only the part of x - point along the normal counts: take the dot product.",
    ),
    "SOLID_ON_THE_WRONG_SIDE": (
        "It takes the side that the normal points to for the solid one.",
        "The normal points out of the solid: depth = r - (x - point) . normal.",
    ),
    # -- blows
    "RESTITUTION_SQUARED": (
        "The bodies part at e squared times the speed of approach.",
        "e is a ratio of speeds: the factor is 1 + e. It is the energy that goes with e squared.",
    ),
    "RESTITUTION_AS_ENERGY": (
        "e is used as the share of energy that is left, so the speeds go with its square root.",
        "e is a ratio of speeds: the factor is 1 + e, and the energy that is left follows from it.",
    ),
    "RESTITUTION_IGNORED": (
        "The restitution changes nothing: every blow is fully elastic, or none rebounds.",
        "Multiply by 1 + e: 1 to stop the approach, and e to send the bodies apart again.",
    ),
    "ONLY_THE_REBOUND": (
        "The impulse has the factor e where it should have 1 + e.",
        "A blow first stops the approach (1) and then throws the bodies apart (e): together 1 + e.",
    ),
    "RESTITUTION_SIGN_FLIPPED": (
        "The impulse has the factor 1 - e: bouncy things do not bounce.",
        "The bodies turn round: from approaching at speed s to parting at e s is a change of (1 + e) s.",
    ),
    "MASS_NOT_INVERSE": (
        "The masses stand where their inverses belong.",
        "An impulse J changes a velocity by J/m, so both together by J (1/ma + 1/mb): divide by that sum "
        "to find J, and by m to apply it.",
    ),
    "MEAN_MASS": (
        "The masses enter by half or twice what they should.",
        "J = (1 + e) s / (1/ma + 1/mb); for equal masses m the divisor is 2/m.",
    ),
    "EQUAL_MASSES_ASSUMED": (
        "It uses one mass for both bodies.",
        "Each has its own: 1/ma + 1/mb. Try masses of 1 kg and 3 kg.",
    ),
    "ONE_MASS_ONLY": (
        "Only one of the masses enters the impulse, as if the other body were a wall.",
        "Both velocities give way: divide by 1/ma + 1/mb.",
    ),
    "MASSES_IGNORED": (
        "The masses play no part.",
        "The same impulse moves a heavy body less: J = (1 + e) s / (1/ma + 1/mb), and each velocity changes "
        "by J/m.",
    ),
    "INFINITE_MASS_NAN": (
        "With an infinite mass it computes inf/inf or 0*inf, and that is nan.",
        "Write it with inverse masses only: 1/inf is 0.0, and a wall then needs no special case. A product "
        "ma*mb does not survive it.",
    ),
    "IMPULSE_ON_SEPARATING": (
        "Bodies that are already moving apart are struck as well.",
        "Act only if they approach, (va - vb) . n > 0. Otherwise an overlap that lasts two samples turns "
        "the bodies back into each other.",
    ),
    "IMPULSE_REVERSED": (
        "The impulse has the wrong sign: the bodies are pulled into each other, faster than they came.",
        "a loses J n and b gains it: va - J/ma n, vb + J/mb n.",
    ),
    "THIRD_LAW_MISSING": (
        "The two bodies do not get equal and opposite impulses, so momentum appears from nowhere.",
        "What b gains, a loses: va - J/ma n and vb + J/mb n with the same J.",
    ),
    "BLOW_NOT_ALONG_NORMAL": (
        "The blow acts along the relative velocity. Smooth bodies can push only along the normal.",
        "Take the speed of approach (va - vb) . n, one number, and send the impulse along n. What moves "
        "across stays as it was.",
    ),
    "SPEED_NOT_ALONG_NORMAL": (
        "The whole relative speed is used where only its part along the normal belongs.",
        "The speed of approach is the dot product (va - vb) . n.",
    ),
    "SPEEDS_NOT_RELATIVE": (
        "The speed of approach is not the difference of the two velocities.",
        "It is va - vb (in space: its part along n), signs included: a body that runs away is approached "
        "more slowly.",
    ),
    "EACH_BODY_ALONE": (
        "Each body is thrown back by its own velocity, as from a wall that stands still.",
        "A blow knows only the relative velocity. Seen from a moving train it must be the same blow.",
    ),
    "RETURNS_SWAPPED": (
        "It returns the right two velocities in the wrong order.",
        "Return (va_next, vb_next): the velocity of a first.",
    ),
    "NO_RESPONSE": (
        "Bodies that run into each other keep their velocities.",
        "Where (va - vb) . n > 0, each velocity changes by its share of the impulse. Return the new values.",
    ),
    "ENERGY_CREATED": (
        "There is more kinetic energy afterwards than before. No blow can do that.",
        "Look for a sign, or for a factor that should be 1 + e with e between 0 and 1.",
    ),
    "BLOW_TOO_STRONG": (
        "The bodies part faster than e times the speed of approach.",
        "J = (1 + e) s / (1/ma + 1/mb) and nothing on top: a push to keep bodies apart is energy "
        "from nowhere.",
    ),
    "BLOW_TOO_WEAK": (
        "The bodies part more slowly than e times the speed of approach.",
        "J = (1 + e) s / (1/ma + 1/mb) with s = (va - vb) . n; afterwards s must be -e times what it was.",
    ),
    "MOMENTUM_LOST": (
        "The total momentum changes, and no outside force acts.",
        "Both bodies must get the same impulse, with opposite signs, divided by their own mass.",
    ),
    "DEPENDS_ON_THE_FRAME": (
        "Seen from a moving train it is a different blow.",
        "Only the difference va - vb may enter: never a velocity by itself.",
    ),
    "DEPENDS_ON_DIRECTION": (
        "Turned round or mirrored, it is a different blow.",
        "Use vectors as wholes: dot products with n and multiples of n, and no single coordinates.",
    ),
    # -- friction
    "FRICTION_IGNORED": (
        "There is no friction in it.",
        "Across the normal acts a second impulse, against the slip: at most mu J, and no more than stops "
        "the slip.",
    ),
    "FRICTION_NOT_CLAMPED": (
        "The impulse of friction is always mu J, even where less would stop the slip. It then drives the "
        "surfaces the other way.",
        "Take the smaller of mu J and |vt| / (1/ma + 1/mb): friction stops a slip and never reverses it.",
    ),
    "FRICTION_ALWAYS_STICKS": (
        "Friction stops every slip, however fast and however smooth the surfaces.",
        "It can do no more than mu J: take the smaller of mu J and |vt| / (1/ma + 1/mb).",
    ),
    "FRICTION_TAKES_THE_LARGER": (
        "Of the two limits of friction the larger one is taken.",
        "Both are limits: min(mu J, |vt| / (1/ma + 1/mb)).",
    ),
    "FRICTION_DRIVES": (
        "Friction acts along the slip and makes it faster.",
        "It acts against the slip: with vt the slip of b seen from a, b gets an impulse along -vt.",
    ),
    "FRICTION_PER_AXIS": (
        "Each coordinate of the slip is limited by itself, which makes a box of Coulomb's cone: friction is "
        "then too strong along diagonals.",
        "Limit the length of the tangential impulse, and keep its direction: against vt.",
    ),
    "STICKING_WITHOUT_MASS": (
        "The slip, a speed, is compared with an impulse.",
        "The impulse that stops the slip is |vt| / (1/ma + 1/mb), in N s like mu J.",
    ),
    "FRICTION_PROPORTIONAL": (
        "Friction grows with the speed of the slip. That is the law of a thick oil.",
        "Coulomb's friction does not ask how fast: it is mu J against the slip, unless less stops it.",
    ),
    "FRICTION_THIRD_LAW_MISSING": (
        "Friction does not act on both bodies equally and oppositely.",
        "What b gets across the normal, a gets with the opposite sign.",
    ),
    "FRICTION_NOT_RELATIVE": (
        "The slip is taken from one body's velocity alone.",
        "Surfaces rub by their relative velocity: vt is the part of vb - va across the normal.",
    ),
    "FRICTION_NOT_ACROSS": (
        "The whole relative velocity is taken for the slip, its part along the normal included.",
        "Take that part out first: u - (u . n) n with u = vb - va.",
    ),
    "FRICTION_WITHOUT_REBOUND": (
        "The limit is mu times an impulse without the rebound's share.",
        "The surfaces press on each other during the whole blow: J contains the factor 1 + e.",
    ),
    "NO_SLIDING_NAN": (
        "Where nothing slides, the slip has no direction, and dividing by its length gives nan.",
        "Divide by the length of vt only if it is not zero.",
    ),
    # -- any function
    "MUTATES_INPUT": (
        "The caller still needs the old numbers.",
        "Write va = va - ..., which makes a new array, instead of va -= ..., which changes the old one.",
    ),
    # -- time of impact
    "TUNNELS": (
        "It looks only at some instants, and whatever meets between two of them goes through.",
        "Solve for the moment: |dx + dv t| = ra + rb is a quadratic equation in t. No sampling, and no "
        "speed is too high.",
    ),
    "NEVER_FINDS_A_CONTACT": (
        "It returns None whatever happens.",
        "Where the spheres approach and their paths come close enough, return the smaller root of "
        "|dx + dv t| = ra + rb.",
    ),
    "TIME_OF_IMPACT_LATE_ROOT": (
        "It returns the later root: the moment when the bodies, having passed through each other, "
        "come apart.",
        "The quadratic has two roots. Contact begins at the smaller one, with the minus sign before "
        "the root.",
    ),
    "IMPACT_BEYOND_STEP": (
        "It announces contacts that happen after the step.",
        "Only times up to dt count; return None for a later one.",
    ),
    "IMPACT_IN_THE_PAST": (
        "It announces contacts that were: the bodies are already moving apart.",
        "Return None unless the bodies approach: the centres' distance must be shrinking now.",
    ),
    "OVERLAP_IGNORED": (
        "Bodies that overlap already and approach are not reported as touching now.",
        "Test this first: overlapping and approaching means contact at 0.0.",
    ),
    "OVERLAP_ALWAYS_HITS": (
        "Bodies that overlap but move apart are reported as hitting.",
        "Nothing is to be done for those: return None. An impact needs an approach.",
    ),
    "MISSES_COUNT_AS_HITS": (
        "It divides the gap by a speed, as if bodies always met head on. Those that pass beside each other "
        "count as hits, and oblique ones come at the wrong time.",
        "Use vectors: |dx + dv t| = ra + rb, squared, is a quadratic in t. No real root means a miss.",
    ),
    "MOMENT_TOO_COARSE": (
        "The contacts are found, but their times are only roughly right.",
        "The quadratic equation gives the moment to the last digit. If you solve it, compare each term with "
        "|dx + dv t|**2 = (ra + rb)**2; if you search in steps, solve it instead.",
    ),
    "CONTACTS_MISSED": (
        "It returns None for bodies that do meet within the step.",
        "They meet where the quadratic |dx + dv t|**2 = (ra + rb)**2 has a real root that is neither before "
        "now nor after dt: compare each of your conditions for None with that.",
    ),
    "RADII_NOT_SQUARED": (
        "In the quadratic, the sum of the radii stands where its square belongs.",
        "At contact |dx + dv t| = ra + rb. Squared, that has (ra + rb)**2 on its right side.",
    ),
    "RADII_SQUARED_APART": (
        "The radii are squared one by one and then added.",
        "Add the radii first, then square: (ra + rb)**2 is more than ra**2 + rb**2.",
    ),
    "RETURNS_SHARE_OF_STEP": (
        "It returns the share of the step instead of seconds.",
        "Multiply by dt: the answer is a time in seconds from the start of the step.",
    ),
    "RETURNS_TIME_LEFT": (
        "It returns the time that is left after the contact.",
        "The answer is the time from the start of the step to the contact.",
    ),
    "NO_RELATIVE_MOTION": (
        "Where both bodies have the same velocity it divides by zero.",
        "Two bodies at rest relative to each other never meet: return None before you divide.",
    ),
    "ROOT_OF_A_NEGATIVE": (
        "Where the two pass beside each other the number under the root is negative, and its root is nan.",
        "Look at that number before you take its root: if it is negative they never touch, so return None.",
    ),
    # -- simulations
    "PASSES_THROUGH": (
        "The bodies go through each other as if there were no contact in it: this program shows straight "
        "lines.",
        "Each step, ask whether the gap closes within it; if so, move to the contact, apply the blow, and "
        "use the rest of the step for the way apart.",
    ),
    "IMPACT_AT_SAMPLE": (
        "The blow is applied at a sample, after the surfaces have met: everything afterwards is late by "
        "part of a step.",
        "Find the time of contact inside the step, move there, apply the blow, then move on for the rest of "
        "the step.",
    ),
    "REST_OF_STEP_LOST": (
        "After the blow nothing moves until the next sample: the rest of that step is lost.",
        "A contact at time s into the step leaves h - s: move on for that long with the new velocities.",
    ),
    "EULER_IN_FLIGHT": (
        "Already before the first contact the fall is off by g h t/2: the mark of an Euler step.",
        "Free flight has an exact step: z + v h - g h**2 / 2 and v - g h.",
    ),
    "RESTING_JITTER": (
        "The ball never comes to rest: it goes on hopping by less than a step can show.",
        "When it touches and its speed is at most g h, put it down: z = radius and v = 0 from then on.",
    ),
    "SINKS_THROUGH_FLOOR": (
        "In the end the ball sinks into the floor.",
        "Once at rest it stays: neither gravity nor the step moves it any more.",
    ),
    "RESTS_TOO_EARLY": (
        "The ball is put to rest while it still has speed to bounce with.",
        "It rests only when it touches with a speed of at most g h; faster, it bounces.",
    ),
    "TRUNCATED_STEP_COUNT": (
        "The number of steps is cut off instead of rounded.",
        "In floating point t_end/h may fall just below a whole number: use round(t_end / h).",
    ),
    "OFF_BY_ONE_SAMPLE": (
        "There is a sample too many or too few: n steps join n + 1 states.",
        "Record the initial state before the loop and one state after each of the n steps.",
    ),
    "INITIAL_STATE_MISSING": (
        "The first sample is not the initial state: the recording starts after the first step.",
        "Store the initial state at time 0 before the loop, and one state after each of the n steps.",
    ),
    "TIME_ACCUMULATES": (
        "The times are a running sum of h, and rounding adds up.",
        "Compute sample number i's time as i * h.",
    ),
}


def named(code: str, divergence: Divergence | None = None) -> Diagnosis:
    """The diagnosis of that code."""
    looks_like, advice = WORDS[code]
    return Diagnosis(code, looks_like, advice, divergence)
