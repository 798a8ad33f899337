"""Mistakes in `collisions`: words beside the programs that they are true of."""

from __future__ import annotations

import math

import numpy as np

from course.authoring.mistakes import Mistakes
from course.scoring import kit

mistakes = Mistakes()

mistakes(
    "NORMAL_REVERSED",
    "The normal points the other way: from b to a, or into the solid.",
    "The normal points from a to b: (xb - xa) over its length. A plane's normal is the one you are given.",
).edit("detect_sphere_sphere", {"0, normal": "0, -normal"}).edit(
    "detect_sphere_plane", {"0, normal": "0, -normal"}
)
mistakes(
    "DEPTH_SIGN_FLIPPED",
    "Your code returns the gap instead of the depth: it is positive when the bodies are apart and negative when they overlap.",
    "depth = ra + rb - distance, or r - height: positive when they overlap, negative when they are apart.",
).edit("detect_sphere_sphere", {"normal, depth": "normal, -depth"})
mistakes(
    "DEPTH_CLAMPED",
    "The depth is cut off at some value, so it no longer says how far apart two bodies are, or how deep one lies in the other.",
    "Return the depth as you compute it, with its sign.",
).edit("detect_sphere_sphere", {"normal, depth": "normal, max(depth, 0.0)"})
mistakes(
    "NORMAL_UNDEFINED",
    "Where the two centres coincide, the normal is nan: zero is divided by zero.",
    "Test for a distance of zero first and return any unit vector there, such as the first axis.",
    kind="nan",
).edit("detect_sphere_sphere", {" if distance > 0 else np.eye(1, len(apart))[0]": ""})
mistakes(
    "RESULTS_IN_OTHER_ORDER",
    "The normal is a vector and stands between two single values.",
    "Return (touching, normal, depth).",
    kind="fact",
).edit("detect_sphere_sphere", {"return depth >= 0, normal, depth": "return depth >= 0, depth, normal"})
mistakes(
    "ONE_COORDINATE_ONLY",
    "Where a scalar product belongs, only one coordinate counts.",
    "Take all of them: (x - point) @ normal, (va - vb) @ normal.",
).edit(
    "detect_sphere_plane",
    {"float(np.dot(np.subtract(x, point, dtype=float), normal))": "(x[-1] - point[-1]) * normal[-1]"},
).edit(
    "detect_sphere_plane",
    {"float(np.dot(np.subtract(x, point, dtype=float), normal))": "(x[0] - point[0]) * normal[0]"},
).edit("resolve", {"(va - vb) @ n,": "(va[0] - vb[0]) * n[0],"}).edit(
    "resolve", {"(va - vb) @ n,": "(va[-1] - vb[-1]) * n[-1],"}
)
mistakes(
    "DISTANCE_UNSIGNED",
    "The height above the plane has lost its sign: a centre inside the solid counts as outside.",
    "Use it with its sign, without abs(): inside the solid (x - point) . normal is negative, and the depth is then larger than r.",
).edit("detect_sphere_plane", {"float(np.dot": "abs(np.dot"}).body(
    "detect_sphere_plane",
    """
        height = (x - point) @ normal
        return bool(abs(height) <= r), normal if height >= 0 else -normal, r - abs(height)
    """,
)
mistakes(
    "LOWEST_POINT_OF_BALL",
    "The depth is that of the point below the centre, along the last axis.",
    "The deepest point lies against the normal: take r less the part of x - point along it.",
).edit("detect_sphere_plane", {"depth = r - ": "depth = r * normal[-1] - "})
mistakes(
    "PLANE_POINT_IGNORED",
    "The plane's point is left out, or added where it should be subtracted.",
    "Measure the height from a point of the plane: (x - point) . normal.",
).edit("detect_sphere_plane", {"np.subtract(x, point, dtype=float)": "x"})
mistakes(
    "PLANE_ASSUMED_LEVEL",
    "Only one coordinate counts, as if every plane were a level floor.",
    "The height above a tilted plane is the dot product (x - point) . normal.",
).edit(
    "detect_sphere_plane",
    {"float(np.dot(np.subtract(x, point, dtype=float), normal))": "(x[-1] - point[-1])"},
)
mistakes(
    "RESTITUTION_SQUARED",
    "The bodies part at e squared times the speed of approach.",
    "e is a ratio of speeds: use it as it is given. It is the energy that scales with e squared.",
).edit("impulse_1d", {"- vb, restitution)": "- vb, restitution**2)"})
mistakes(
    "MASS_NOT_INVERSE",
    "Something else made from the masses stands where the inverse masses 1/ma and 1/mb belong.",
    "J = (1 + e) s / (1/ma + 1/mb), and each velocity changes by J over its own mass.",
).edit(
    "impulse_1d",
    {
        "_impulse(ma, mb, va - vb, restitution)": "(1 + restitution) * (va - vb) / (ma + mb) if va > vb else 0.0"
    },
).edit("resolve", {"va - impulse / ma, vb + impulse / mb": "va - impulse * ma, vb + impulse * mb"}).edit(
    "impulse_1d",
    {"_impulse(ma, mb, va - vb, restitution)": "(1 + restitution) * max(va - vb, 0.0) * (1 / ma + 1 / mb)"},
)
mistakes(
    "IMPULSE_ON_SEPARATING",
    "Bodies that do not approach each other get an impulse.",
    "Act only if (va - vb) . n > 0, on a line if va > vb. Bodies that move apart no longer press on each other: neither an impulse nor friction acts on them.",
    kind="fact",
).edit(
    "impulse_1d",
    {"_impulse(ma, mb, va - vb, restitution": "(1 + restitution) * (va - vb) / (1 / ma + 1 / mb"},
).edit(
    "resolve", {"(va - vb) @ n, restitution)": "abs((va - vb) @ n), restitution) * np.sign((va - vb) @ n)"}
).edit(
    "resolve_with_friction",
    {"(mu * along, speed /": "(mu * _impulse(ma, mb, abs(closing), restitution), speed /"},
)
mistakes(
    "INFINITE_MASS_NAN",
    "With an infinite mass the result is not finite: inf/inf, 0*inf and inf - inf are nan.",
    "Use inverse masses only: 1/inf is 0.0, so a wall needs no special case. A product such as ma*mb becomes infinite.",
    kind="nan",
).edit(
    "impulse_1d",
    {
        "_impulse(ma, mb, va - vb, restitution)": "(1 + restitution) * (va - vb) * ma * mb / (ma + mb) if va > vb else 0.0"
    },
).edit(
    "simulate_head_on",
    {"_impulse(m[0], m[1], closing, restitution": "(1 + restitution) * closing * m[0] * m[1] / (m[0] + m[1]"},
).edit(  # nan only where the wall is on the left
    "simulate_head_on", {"vb + impulse / m[1]": "vb + impulse * (m[0] / m[1]) / m[0]"}
)
mistakes(
    "SPEEDS_NOT_RELATIVE",
    "The speed of approach is not the difference of the two velocities.",
    "It is va - vb (in space: its component along n), with signs: a body that moves away is approached more slowly.",
).edit(
    "impulse_1d",
    {
        "_impulse(ma, mb, va - vb, restitution)": "(1 + restitution) * (abs(va) + abs(vb)) / (1 / ma + 1 / mb) if va > vb else 0.0"
    },
)
mistakes(
    "APPROACH_REVERSED",
    "Your code acts on bodies that move apart, and leaves alone those that run into each other.",
    "They approach where the speed of approach, va - vb (in space: its component along n), is positive.",
).edit("resolve", {"_impulse(ma, mb, (va - vb)": "-_impulse(ma, mb, (vb - va)"})
mistakes(
    "THIRD_LAW_MISSING",
    "The two bodies do not receive equal and opposite impulses, so momentum is not conserved.",
    "What b gains, a must lose: va - J/ma n and vb + J/mb n with the same J.",
).around("resolve", "return va, _right(ma, mb, va, vb, normal, restitution)[1]")
mistakes(
    "BLOW_NOT_ALONG_NORMAL",
    "The impulse acts in a direction other than the normal, such as that of the relative velocity. Smooth bodies can push each other only along the normal.",
    "Compute the speed of approach (va - vb) . n, which is one number, and apply the impulse along n. Across the normal it changes nothing.",
).edit("resolve", {"restitution) * n": "restitution) * (va - vb) / (np.linalg.norm(va - vb) or 1.0)"})
mistakes(
    "EACH_BODY_ALONE",
    "Each body rebounds with its own velocity, as if it had hit a wall at rest.",
    "An impact depends only on the relative velocity: seen from a moving train it must be the same impact.",
).body(
    "resolve",
    """
        if (va - vb) @ normal <= 0:
            return va, vb
        return tuple(v - (1 + restitution) * (v @ normal) * normal for v in (va, vb))
    """,
)
mistakes(
    "MUTATES_INPUT",
    "Your code works on the caller's own array, and not on a copy.",
    "Write a = a - b, which makes a new array: a -= b and a[0] = b change the caller's array. An array that you fill, change later or return should be a copy.",
    kind="fact",
).body(
    "resolve",
    """
        impulse = _impulse(ma, mb, (va - vb) @ normal, restitution) * normal
        va -= impulse / ma
        vb += impulse / mb
        return va, vb
    """,
).around(
    "detect_sphere_sphere",
    """
        xb -= xa
        return _right(np.zeros(len(xb)), ra, xb, rb)
    """,
).around(
    "detect_sphere_plane",
    """
        x -= point
        return _right(x, r, np.zeros(len(x)), normal)
    """,
).around(
    "time_of_impact",
    """
        xb -= xa
        vb -= va
        return _right(np.zeros(len(xb)), np.zeros(len(vb)), ra, xb, vb, rb, dt)
    """,
)
mistakes(
    "BLOW_TOO_STRONG",
    "The bodies separate faster than at e times the speed of approach.",
    "Along the normal only J = (1 + e) s / (1/ma + 1/mb) acts, also at a wall: friction has no part along n. Compute it by hand for one pair, and compare.",
    kind="consequence",
).edit(
    "resolve", {"restitution) * n": "restitution) * n + ((va - vb) @ n > 0) * 0.05 / (1 / ma + 1 / mb) * n"}
)
mistakes(
    "FRICTION_NOT_CLAMPED",
    "The friction impulse is always mu J, even where less would stop the slip. It then reverses the slip.",
    "Take the smaller of mu J and |vt| / (1/ma + 1/mb): friction can stop a slip but never reverses it.",
).edit(
    "resolve_with_friction", {"min(mu * along, speed / (1 / ma + 1 / mb))": "mu * along if speed else 0.0"}
)
mistakes(
    "FRICTION_ALWAYS_STICKS",
    "Wherever there is friction, it stops the slip, however fast the bodies slide and however small mu is.",
    "Friction is limited to mu J: take the smaller of mu J and |vt| / (1/ma + 1/mb).",
).edit(
    "resolve_with_friction",
    {"min(mu * along, speed / (1 / ma + 1 / mb))": "speed / (1 / ma + 1 / mb) if mu * along else 0.0"},
)
mistakes(
    "SLIP_DIRECTION_BY_SIGNS",
    "Friction gets its direction from the signs of the slip's coordinates.",
    "The direction is vt / |vt|: divide the slip by its length.",
).edit("resolve_with_friction", {"across / speed * slip": "across * np.sign(slip)"})
mistakes(
    "FRICTION_PER_AXIS",
    "Friction is worked out for each coordinate of the slip by itself, which turns Coulomb's cone into a box: it is then too strong along the diagonals.",
    "Limit the length of the tangential impulse, and keep its direction, which is against vt.",
).edit(
    "resolve_with_friction",
    {
        "across = min(mu * along, speed / (1 / ma + 1 / mb))": "give = 1 / ma + 1 / mb",
        "across / speed * slip if across > 0 else 0.0": "np.clip(slip / give, -mu * along, mu * along)",
    },
)
mistakes(
    "FRICTION_DRIVES",
    "Friction acts in the direction of the slip and makes it faster.",
    "Friction acts against the slip. If vt is the slip of b as seen from a, then b gets an impulse along -vt.",
    kind="consequence",
).edit("resolve_with_friction", {"along * n - (": "along * n + ("})
mistakes(
    "NO_SLIDING_NAN",
    "Where nothing slides, your code returns nan: the slip vt has no direction there.",
    "Divide by the length of vt only if it is not zero, and by nothing else that may be zero.",
    kind="nan",
).edit("resolve_with_friction", {"if across > 0": "if along > 0"})
mistakes(
    "FRICTION_THIRD_LAW_MISSING",
    "The friction impulses on the two bodies are not equal and opposite.",
    "Across the normal, a gets the same impulse as b with the opposite sign.",
).edit("resolve_with_friction", {"va - impulse / ma": "va - along * n / ma"})
mistakes(
    "FRICTION_NOT_RELATIVE",
    "The slip is not the difference of the two velocities: it is computed from one of them alone, or from their sum.",
    "Friction depends on the relative velocity: vt is the component of vb - va across the normal.",
).edit("resolve_with_friction", {"vb - va + closing * n": "(va @ n) * n - va"})
mistakes(
    "FRICTION_EACH_ALONE",
    "Friction brakes each body's own velocity across the normal, as if the other one stood still.",
    "Friction acts on the slip, which is relative: vt is the component of vb - va across the normal. Both bodies get the same Jt, in opposite directions.",
).body(
    "resolve_with_friction",
    """
        closing = (va - vb) @ normal
        if closing <= 0:
            return va, vb
        J = (1 + restitution) * closing / (1 / ma + 1 / mb)
        ends = []
        for m, v, sign in ((ma, va, -1), (mb, vb, 1)):
            along = (v @ normal) * normal
            across = v - along
            speed = np.linalg.norm(across)
            brake = min(mu * J / m, speed) / speed if speed else 0.0
            ends.append(along + sign * J / m * normal + (1 - brake) * across)
        return tuple(ends)
    """,
)
mistakes(
    "TIME_OF_IMPACT_LATE_ROOT",
    "The later root is taken, at which the bodies, having passed through each other, would come apart.",
    "The quadratic has two roots. Bodies that are apart touch first at the smaller one, with the minus sign before the square root. If they overlap and approach, the answer is 0.0.",
).edit("time_of_impact", {"c / (b + math.sqrt(b * b - a * c))": "(b + math.sqrt(b * b - a * c)) / a"})
mistakes(
    "TUNNELS",
    "A contact within the step is missed, or found late.",
    "Compute when bodies that approach touch (|dx + dv t| = ra + rb is a quadratic equation in t; on a line it is the gap over the speed of approach), and compare that time, the smaller root, with the step. Where the other root lies does not matter, and that they overlap at no sample proves nothing.",
).around(
    "time_of_impact",
    """
        apart = xb + vb * dt - xa - va * dt
        now = np.linalg.norm(xb - xa) <= ra + rb
        return _right(xa, va, ra, xb, vb, rb, dt) if now or np.linalg.norm(apart) <= ra + rb else None
    """,
).body(
    "time_of_impact",
    """
        x, v = xb - xa, vb - va
        if x @ v >= 0:
            return None
        t = np.linspace(0.0, dt, 1001)
        hits = np.flatnonzero(np.linalg.norm(x + t[:, None] * v, axis=1) <= ra + rb)
        return float(t[hits[0]]) if len(hits) else None
    """,
).edit(
    "simulate_head_on",
    {"gap <= closing * h else h": "gap <= closing * h and xb - xa - closing * h > -2 * radius else h"},
)
mistakes(
    "IMPACT_BEYOND_STEP",
    "A contact that happens after the end of the step is reported.",
    "Only times up to dt count; return None for a later contact.",
    kind="consequence",
).around("time_of_impact", "return _right(xa, va, ra, xb, vb, rb, math.inf)")
mistakes(
    "MISSES_COUNT_AS_HITS",
    "The time is a gap over a speed, as if all bodies met head on. Bodies that pass beside each other can then count as hits.",
    "Use vectors: |dx + dv t| = ra + rb, squared, is a quadratic in t. If it has no real root, the bodies miss each other.",
).edit(
    "time_of_impact",
    {
        "    if b * b < a * c:\n        return None\n": "",
        "c / (b + math.sqrt(b * b - a * c))": "(math.sqrt(x @ x) - ra - rb) / math.sqrt(a)",
    },
)
mistakes(
    "OVERLAP_ALWAYS_HITS",
    "Bodies that overlap but do not approach are reported as colliding.",
    "Return None for them: they need no impulse.",
    kind="consequence",
).around(
    "time_of_impact",
    "return 0.0 if np.linalg.norm(xb - xa) <= ra + rb else _right(xa, va, ra, xb, vb, rb, dt)",
)
mistakes(
    "APPROACH_NOT_ASKED",
    "Your code does not ask whether the bodies approach: those that move apart get a time, too.",
    "Return None first of all where x . v >= 0, whether they overlap or not.",
).body(
    "time_of_impact",
    """
        x, v, R = xb - xa, vb - va, ra + rb
        a, b, c = v @ v, x @ v, x @ x - R**2
        if c < 0:
            return 0.0
        if a == 0 or b * b < a * c:
            return None
        t = (-b - math.sqrt(b * b - a * c)) / a
        return float(t) if t <= dt else None
    """,
)
mistakes(
    "OVERLAP_LEVEL_HITS",
    "Bodies that overlap and neither approach nor part are reported as colliding.",
    "Where x . v is zero they do not approach: return None for every x . v >= 0.",
    kind="consequence",
).edit(
    "time_of_impact",
    {
        "if nearing <= 0:": "if nearing < 0:",
        "    # |x + v t| = R is a t² - 2 b t + c = 0 with b > 0; the first root, written without a difference.": "",
        "if b * b < a * c:": "if a == 0 or b * b < a * c:",
    },
)
mistakes(
    "PASSES_THROUGH",
    "Here the bodies go through each other: their paths stay straight lines.",
    "In each step ask whether the gap closes within it, however slow or fast they are. If so, move to the contact, apply the impact, and use the rest of the step to move apart.",
    kind="consequence",
).body(
    "simulate_head_on",
    """
        t = h * np.arange(round(t_end / h) + 1)
        v = np.tile(np.array(v0, float), (len(t), 1))
        return t, x0 + v * t[:, None], v
    """,
)
mistakes(
    "IMPACT_AT_SAMPLE",
    "Up to the end of the step the bodies move as if they had not met: the impact comes at a sample, after that.",
    "Find the time of contact inside the step, move there, apply the impact, then move on for the rest of the step with the new velocities.",
    kind="consequence",
).edit(
    "simulate_head_on",
    {
        "gap / closing if 0 < closing and gap <= closing * h else h": "h",
        "wait < h": "closing > 0 and xb - xa <= 2 * radius",
    },
).edit(
    "simulate_drop",
    {
        "math.sqrt(v[i] ** 2 + 2 * g * max(z[i] - radius, 0.0))": "-v[i + 1]",
        "h - (v[i] + speed) / g": "0.0",
        "return t, z, v": "return t, list(z), list(v)",
    },
)
mistakes(
    "REST_OF_STEP_LOST",
    "After the impact the bodies stand still until the step ends: the rest of it is lost.",
    "A contact at time s into the step leaves h - s: move on for that time with the new velocities.",
).edit(
    "simulate_head_on",
    {
        "max(xb - xa - 2 * radius, 0.0)": "xb - xa - 2 * radius",
        "wait < h": "0 < closing and gap <= closing * h",
        "xa + va * (h - wait), xb + vb * (h - wait)": "xa, xb",
    },
).edit("simulate_drop", {"h - (v[i] + speed) / g": "0.0", "return t, z, v": "return t, list(z), list(v)"})
mistakes(
    "EQUAL_MASSES_ASSUMED",
    "The impulse is computed as if both bodies had the mass of one of them.",
    "Each body has its own mass: 1/ma + 1/mb. Try masses of 1 kg and 3 kg.",
).edit("simulate_head_on", {"_impulse(m[0], m[1]": "_impulse(m[0], m[0]"})
mistakes(
    "SAME_MASS_TWICE",
    "Both velocities change by the impulse over the same mass.",
    "Each velocity changes by J over its own mass: that of a by J/ma, that of b by J/mb.",
).edit("resolve", {"vb + impulse / mb": "vb + impulse / ma"}).edit(
    "simulate_head_on", {"impulse / m[0]": "impulse / m[1]"}
)
mistakes(
    "FRICTION_OVER_OTHER_MASS",
    "Friction changes a velocity by its impulse over the other body's mass.",
    "Across the normal as along it, each velocity changes by the impulse over its own mass: by Jt/ma and Jt/mb.",
)
mistakes(
    "FRICTION_AXIS_SIGN_LOST",
    "The direction of friction has lost the signs of its coordinates.",
    "On b it acts along -vt / |vt|, each coordinate with its sign: no abs().",
)
mistakes(
    "RESTITUTION_ON_TOP",
    "The velocities after the impact are multiplied by e, which is in the impulse already.",
    "e is the speed of parting over that of approach: it belongs in the factor 1 + e of J, and nowhere else.",
)
mistakes(
    "GRAVITY_TYPED_IN",
    "In one place a fixed number such as 9.81 stands where the given g belongs.",
    "Use the argument g everywhere: for the height, the velocity, the speed at the floor, the time to it, and in the rule for the rest.",
).edit("simulate_drop", {"v[i] - g * h\n        if": "v[i] - 9.81 * h\n        if"})
mistakes(
    "FLIGHT_WITH_NEW_VELOCITY",
    "The height moves with the velocity at the end of the step, and g h**2 / 2 is subtracted besides.",
    "z + v h - g h**2 / 2 takes the velocity v from the start of the step: compute the height first, then the velocity.",
)
mistakes(
    "VELOCITIES_SCALED",
    "Along the normal the velocities are those after an impact without loss, each multiplied by e.",
    "e is the speed of parting over that of approach: it belongs in the factor 1 + e of J, and nowhere else.",
).around(
    "resolve",
    """
        if (va - vb) @ normal <= 0:
            return va, vb
        return tuple(restitution * v for v in _right(ma, mb, va, vb, normal, 1.0))
    """,
).around(
    "resolve",
    """
        if (va - vb) @ normal <= 0:
            return va, vb
        after = _right(ma, mb, va, vb, normal, 1.0)
        return tuple(v - (1 - restitution) * (v @ normal) * normal for v in after)
    """,
).edit(
    "simulate_head_on",
    {
        "closing, restitution)": "closing, 1.0)",
        "va, vb = va - impulse / m[0], vb + impulse / m[1]": "va, vb = restitution * (va - impulse / m[0]), restitution * (vb + impulse / m[1])",
    },
)
mistakes(
    "RADIUS_IGNORED",
    "The bodies are taken for points, without radii.",
    "The surfaces touch while the centres are still ra + rb apart (or r from a wall).",
).around("simulate_head_on", "return _right(m, x0, v0, 0.0, restitution, t_end, h)").around(
    "simulate_drop", "return _right(z0, v0, 0.0, restitution, g, t_end, h)"
)
mistakes(
    "TRUNCATED_STEP_COUNT",
    "The number of steps is cut off instead of rounded: t_end/h may come out just below a whole number.",
    "Use round(t_end / h), and return one sample more than there are steps.",
).around("simulate_head_on", "return _right(m, x0, v0, radius, restitution, int(t_end / h) * h, h)").around(
    "simulate_drop", "return _right(z0, v0, radius, restitution, g, int(t_end / h) * h, h)"
)
mistakes(
    "RESTING_JITTER",
    "The ball is not on the floor where it must be at rest already.",
    "Put the ball to rest the first time that it touches the floor at a speed of at most g h: z = radius and v = 0 from then on. Compare with g h itself: not with a fixed speed, and not with a part of g h.",
    true_too=("SINKS_THROUGH_FLOOR",),
).edit(
    "simulate_drop",
    {
        "up = restitution * speed": "up = max(restitution * speed, g * left / 2)",
        "resting = up <= g * h": "resting = False",
        "return t, z, v": "return t, list(z), list(v)",
    },
)
mistakes(
    "RESTITUTION_AS_ENERGY",
    "The speeds scale with the square root of e, as if e were the share of the energy, or of the height, that remains.",
    "e is a ratio of speeds: use it as it is given. The remaining energy follows from it.",
).around("simulate_drop", "return _right(z0, v0, radius, math.sqrt(restitution), g, t_end, h)")
mistakes(
    "EULER_IN_FLIGHT",
    "Before the first contact the fall is off by g h t/2 already, the error of an Euler step.",
    "Free flight has an exact step: z + v h - g h**2 / 2 for the height and v - g h for the velocity.",
    kind="consequence",
).body(
    "simulate_drop",
    """
        n = round(t_end / h)
        rows, z, v = [(z0, v0)], z0, v0
        for i in range(n):
            v = v - g * h
            z = z + v * h
            if z <= radius and v < 0:
                v = -restitution * v
                if v <= g * h:
                    z, v = radius, 0.0
            rows.append((z, v))
        return h * np.arange(n + 1), [r[0] for r in rows], [r[1] for r in rows]
    """,
)
mistakes(
    "SINKS_THROUGH_FLOOR",
    "In the end the ball sinks into the floor.",
    "When it touches at a speed of at most g h, put it down: z = radius and v = 0 from then on.",
).around(
    "simulate_drop",
    """
        t, z, v = _right(z0, v0, radius, restitution, g, t_end, h)
        still = v == 0.0
        still[0] = v0 == 0.0 and z0 == radius
        if still.any():
            s = np.maximum(t - t[np.argmax(still)], 0.0)
            z, v = z - g * s * s / 2, v - g * s
        return t, z, v
    """,
)
mistakes(
    "RESTS_ABOVE_G_H",
    "The ball is put to rest by a speed at the floor that is above g h.",
    "Compare with g times h the speed that it has at the floor: not its square, and not that at the end of the step.",
).edit("simulate_drop", {"up <= g * h": "up * up <= 2 * g * h"}).edit(
    "simulate_drop", {"up <= g * h": "up <= g"}
).edit("simulate_drop", {"up <= g * h": "abs(up - g * left) <= g * h"})
mistakes(
    "RESTS_TOO_EARLY",
    "The ball is put to rest while it should still move.",
    "Put it to rest only where it touches the floor, and only if its speed there, sqrt(v**2 + 2 g (z - radius)), is at most g h.",
).around(
    "simulate_drop",
    """
        t, z, v = _right(z0, v0, radius, restitution, g, t_end, h)
        speed = math.sqrt(v0 * v0 + 2 * g * (z0 - radius))
        late = t > (v0 + speed) / g + 2 * restitution * speed / g
        return t, np.where(late, radius, z), np.where(late, 0.0, v)
    """,
)
mistakes(
    "RESTS_IN_THE_AIR",
    "The ball stops in the air where it is slow, as at the top of its flight.",
    "Slow is not enough: it rests where it touches the floor with a speed of at most g h, and flies on everywhere else.",
).edit(
    "simulate_drop", {"if resting:": "if resting or abs(v[i]) <= g * h:", "= radius, 0.0": "= z[i], 0.0"}
).edit(
    "simulate_drop",
    {
        "if resting:": "if resting or (abs(v[i]) <= g * h and z[i] < 0.9 * z0):",
        "= radius, 0.0": "= z[i], 0.0",
    },
).edit(
    "simulate_drop",
    {
        "    return t, z, v": "    slow = np.abs(v) <= g * h\n    slow[0] = False\n    if slow.any():\n        z[np.argmax(slow) :], v[np.argmax(slow) :] = z[np.argmax(slow)], 0.0\n    return t, z, v"
    },
)
mistakes(
    "RADII_NOT_SQUARED",
    "In the quadratic, the sum of the radii, or twice the sum, appears where its square belongs.",
    "At contact |dx + dv t| = ra + rb. Squaring both sides gives (ra + rb)**2 on the right.",
).edit("time_of_impact", {"(ra + rb) ** 2": "(ra + rb)"})
mistakes(
    "RADII_SQUARED_APART",
    "The radii are squared separately and then added.",
    "Add the radii first. Where a square is needed, it is (ra + rb)**2, which is more than ra**2 + rb**2.",
).edit("time_of_impact", {"(ra + rb) ** 2": "(ra**2 + rb**2)"})
mistakes(
    "GAP_OVER_SPEED",
    "The gap between the surfaces is divided by the speed, as if every meeting were head on.",
    "Off centre they touch later: solve |dx + dv t|**2 = (ra + rb)**2.",
).edit(
    "time_of_impact",
    {"t = c / (b + math.sqrt(b * b - a * c))": "t = (math.sqrt(x @ x) - ra - rb) / math.sqrt(a)"},
)
mistakes(
    "MOMENT_TOO_COARSE",
    "The contacts are found, but not at their exact times.",
    "Solve |dx + dv t|**2 = (ra + rb)**2, which gives the exact time: compare each term, and round nothing. Of spheres that overlap and approach it is 0.0.",
    kind="consequence",
).around(
    "time_of_impact",
    """
        if _right(xa, va, ra, xb, vb, rb, dt) is None:
            return None
        x, v = xb - xa, vb - va
        low, high = 0.0, min(dt, float(-(x @ v) / (v @ v)))
        for _ in range(10):
            middle = (low + high) / 2
            touch = np.linalg.norm(x + middle * v) <= ra + rb
            low, high = (low, middle) if touch else (middle, high)
        return low
    """,
)
mistakes(
    "REACH_OF_ONE_BODY",
    "Contacts are missed where the gap is longer than the way of the faster body alone. All others are found.",
    "Both bodies move: it is the relative velocity that has to close the gap within dt.",
    kind="fact",
).edit(
    "time_of_impact",
    {
        "a, b, c =": "reach = max(np.linalg.norm(va), np.linalg.norm(vb)) * dt\n    a, b, c =",
        "if b * b": "if math.sqrt(x @ x) - ra - rb > reach or b * b",
    },
)
mistakes(
    "PARTING_WITHIN_STEP",
    "Contacts are missed where the spheres, moving on, would still overlap at dt. All others are found.",
    "Only the first of the two roots is asked for: the later one may lie beyond dt.",
    kind="fact",
).edit("time_of_impact", {"if t <= dt": "if (b + math.sqrt(b * b - a * c)) / a <= dt"})
mistakes(
    "CLOSEST_AFTER_STEP",
    "Contacts are missed where the spheres would be closest only after dt. All others are found.",
    "They touch before that: it is the first root that has to lie within dt.",
    kind="fact",
).edit("time_of_impact", {"if b * b < a * c:": "if b > a * dt or b * b < a * c:"})
mistakes(
    "CONTACTS_MISSED",
    "Some bodies that meet within the step get None.",
    "Bodies that are apart meet where |dx + dv t|**2 = (ra + rb)**2 has a real root from 0 to dt; if they overlap and approach, it is 0.0. Compare each of your conditions for None with that, and the root itself: (-b - sqrt(b**2 - 4*a*c)) / (2*a), all of the denominator divided by.",
    kind="consequence",
).around(
    "time_of_impact",
    """
        x, v = xb - xa, vb - va
        if v @ v > 0:
            nearest = x - (x @ v) / (v @ v) * v
            if np.linalg.norm(nearest) > max(ra, rb):
                return None
        return _right(xa, va, ra, xb, vb, rb, dt)
    """,
).around(
    "time_of_impact",
    """
        if np.linalg.norm(np.subtract(vb, va)) < 0.01 and np.linalg.norm(np.subtract(xb, xa)) > ra + rb:
            return None
        return _right(xa, va, ra, xb, vb, rb, dt)
    """,
)
mistakes(
    "TOUCHING_NEEDS_OVERLAP",
    "Bodies that touch exactly, with a depth of zero, do not count as touching.",
    "`touching` is depth >= 0, not depth > 0, and the depth is ra + rb - d (for the plane r less the height), with nothing added.",
).edit("detect_sphere_sphere", {"depth >= 0": "depth > 0"}).edit(
    "detect_sphere_plane", {"depth >= 0": "depth > 0"}
)
mistakes(
    "CONTACT_MARGIN",
    "Touching is decided by a limit other than zero: a small gap counts as touching, or a small overlap does not.",
    "Remove the margin: touching is depth >= 0.",
).edit("detect_sphere_sphere", {"depth >= 0": "depth >= -0.01"})
mistakes(
    "SLIP_TIMES_E",
    "The whole relative velocity is multiplied by e, its part across the normal too.",
    "Only the part along the normal is turned round and multiplied by e. Across it nothing changes: the impulse is J n.",
).body(
    "resolve",
    """
        va, vb, n = (np.array(a, dtype=float) for a in (va, vb, normal))
        closing = (va - vb) @ n
        if closing <= 0:
            return va, vb
        slip = vb - va + closing * n
        impulse = _impulse(ma, mb, closing, restitution) * n - (1 - restitution) * slip / (1 / ma + 1 / mb)
        return va - impulse / ma, vb + impulse / mb
    """,
)
mistakes(
    "DEPTH_LIMITED",
    "Where one sphere lies deep in the other, the depth is too small, as if it had a limit.",
    "It is ra + rb - d, however deep one lies in the other.",
).edit(
    "detect_sphere_sphere", {"depth = ra + rb - distance": "depth = min(ra + rb - distance, ra, rb)"}
).edit(
    "detect_sphere_sphere", {"depth = ra + rb - distance": "depth = min(ra + rb - distance, 2 * ra, 2 * rb)"}
)
mistakes(
    "GAP_AS_OVERLAP",
    "Spheres with a small gap between them get 0.0, as if they overlapped.",
    "They overlap only where |x| < ra + rb. Compare without a margin: however small the gap is, closing it takes some time.",
).edit("time_of_impact", {"c <= 0": "c <= 1e-3 * (ra + rb) ** 2"})
mistakes(
    "RESTITUTION_DROPPED_WHEN_SLOW",
    "Slow bodies part with less than e times the speed at which they met, or stay together.",
    "e is the same at every speed, also for slow bodies.",
).edit("impulse_1d", {"- vb, restitution)": "- vb, restitution if va - vb > 0.01 else 0.0)"}).edit(
    "resolve", {"@ n, restitution)": "@ n, restitution if (va - vb) @ n > 0.01 else 0.0)"}
).edit(
    "impulse_1d", {"va - vb, restitution": "va - vb, restitution * max(va - vb, 0.0) / (abs(va - vb) + 0.01)"}
).edit("resolve", {"@ n, restitution)": "@ n, restitution * ((va - vb) @ n) / (abs((va - vb) @ n) + 0.01))"})
mistakes(
    "FRICTION_COEFFICIENT_CAPPED",
    "The coefficient of friction is cut off at one.",
    "mu may be larger than one, as for rubber on dry concrete. Use it as it is given.",
).around("resolve_with_friction", "return _right(ma, mb, va, vb, normal, restitution, min(mu, 1.0))")
mistakes(
    "BRIEF_CONTACTS_MISSED",
    "Only contacts are missed at which the bodies overlap for a short part of the step. All times are right.",
    "If your code looks at samples of the step, bodies can meet and part again between two of them. Solve |dx + dv t| = ra + rb for t instead: at any speed the first contact is the smaller root.",
    kind="consequence",
).body(
    "time_of_impact",
    """
        x, v, reach = xb - xa, vb - va, ra + rb
        if x @ v >= 0:
            return None
        if np.linalg.norm(x) < reach:
            return 0.0
        low = 0.0
        for high in np.linspace(0.0, dt, 1001):
            if np.linalg.norm(x + v * high) <= reach:
                for _ in range(100):
                    middle = (low + high) / 2
                    if np.linalg.norm(x + v * middle) > reach:
                        low = middle
                    else:
                        high = middle
                return float(high)
            low = high
        return None
    """,
    also=("CONTACTS_MISSED",),
)
mistakes(
    "SLOW_PAIRS_SPARED",
    "Of these pairs that approach, only the slowest keep their velocities. The others are right.",
    "Every pair with (va - vb) . n > 0 gets its impulse, however slow it is. Compare with zero itself, without a small number or a tolerance.",
    kind="consequence",
).around("impulse_1d", "return _right(ma, mb, va, vb, restitution) if va - vb > 1e-3 else 0.0").around(
    "impulse_1d", "return 0.0 if np.isclose(va, vb) else _right(ma, mb, va, vb, restitution)"
)
mistakes(
    "SLOW_SLIPS_SPARED",
    "Of these pairs that slide past each other, only the slowest have no friction. The others are right.",
    "Jt = min(mu J, |vt| / (1/ma + 1/mb)), however slow the slip is. vt has no direction only where it is zero.",
    kind="consequence",
).edit("resolve_with_friction", {"if across > 0": "if speed > 0.01"})
mistakes(
    "FRICTION_ONLY_WHILE_SLIDING",
    "Where friction could stop the slip, there is none.",
    "There Jt = |vt| / (1/ma + 1/mb), which stops the slip: take the smaller of that and mu J.",
)
mistakes(
    "FRICTION_OTHER_COMPARISON",
    "Whether friction stops the slip is decided by another comparison than that of mu J with |vt| / (1/ma + 1/mb).",
    "Jt = min(mu J, |vt| / (1/ma + 1/mb)): take the smaller of the two impulses, and no other condition is needed.",
)
mistakes(
    "NEAR_CENTRES_COINCIDE",
    "The normal is wrong only where the centres lie very close together.",
    "Centres coincide where their distance is zero, and not where it is small. All others have a direction: (xb - xa)/d.",
    kind="consequence",
).edit("detect_sphere_sphere", {"if distance > 0": "if not np.allclose(xa, xb)"})
mistakes(
    "TIME_TO_FLOOR_SIGN",
    "The time to the floor is computed with the wrong sign of v.",
    "v is upwards, and negative on the way down. From (z, v) the ball gets to the floor after (v + speed)/g, with speed = sqrt(v**2 + 2 g (z - radius)).",
).edit("simulate_drop", {"(v[i] + speed) / g": "(speed - v[i]) / g"})
mistakes(
    "CONTACT_ON_A_LINE",
    "The moment of the contact is computed as if the ball kept one velocity during the step.",
    "It falls faster and faster: from (z, v) it gets to the floor after (v + speed)/g, with speed = sqrt(v**2 + 2 g (z - radius)).",
    true_too=("TIME_LEFT_WRONG",),
).edit(
    "simulate_drop",
    {"(v[i] + speed) / g": "(z[i] - radius) / (z[i] - z[i + 1]) * h"},
)
mistakes(
    "STEP_FOR_THE_REST",
    "After a bounce the height or the velocity is computed with h in the place of what is left of the step.",
    "Both end the step: z = radius + up * left - g * left**2 / 2 and v = up - g * left, where left is h less the time to the contact.",
).edit(
    "simulate_drop",
    {"else up - g * left": "else up - g * h"},
)
mistakes(
    "THROWN_DOWNWARDS",
    "The ball starts with -v0, as if v0 were downwards.",
    "v0 is upwards: a positive one throws the ball up, and gravity changes it to v0 - g h in the first step.",
).around(
    "simulate_drop",
    """
        t, z, v = _right(z0, -v0, radius, restitution, g, t_end, h)
        v[0] = v0
        return t, z, v
    """,
)
mistakes(
    "PATH_MIRRORED",
    "A ball that would be in the floor at the end of the step is put as far above it, or e times as far.",
    "Gravity does not turn round at the floor: fly up to the contact, and from there with e times the speed at the floor for the rest of the step.",
).edit(
    "simulate_drop",
    {
        "math.sqrt(v[i] ** 2 + 2 * g * max(z[i] - radius, 0.0))": "-v[i + 1]",
        "up * left - g * left * left / 2": "radius - z[i + 1]",
        "up - g * left\n": "up\n",
    },
)
mistakes(
    "IN_THE_FLOOR",
    "Here the ball is lower than z = radius: a part of it is in the floor.",
    "z is the height of its centre. It touches where z = radius, at an instant inside the step, and no row is lower.",
    kind="consequence",
).edit(
    "simulate_drop",
    {"z[i + 1] < radius:": "z[i + 1] < 0:"},
)
mistakes(
    "REST_BY_TIME_LEFT",
    "Whether the ball rests is decided with what is left of the step in place of h.",
    "The limit is g h, with all of the step h, wherever in the step the ball touches.",
).edit("simulate_drop", {"up <= g * h": "up <= g * left"}).edit(
    "simulate_drop", {"up <= g * h": "restitution * up <= g * left"}
)
mistakes(
    "MISS_IS_A_NUMBER",
    "Where the bodies do not touch within the step, the result is something other than None.",
    "Return None there: a number would be read as a time, and infinity as one that never comes.",
    kind="consequence",
).around(
    "time_of_impact",
    """
        t = _right(xa, va, ra, xb, vb, rb, dt)
        return -1.0 if t is None else t
    """,
)
mistakes(
    "FIRST_STEP_MISSED",
    "A contact in the first step, or at its very start, is missed, and the bodies go through each other.",
    "In every step, including the first, ask before you move the bodies whether the gap closes within it. A gap of zero has closed already.",
).around(
    "simulate_head_on",
    """
        gap, closing = x0[1] - x0[0] - 2 * radius, v0[0] - v0[1]
        t, x, v = _right(m, x0, v0, radius, restitution, t_end, h)
        if closing > 0 and gap <= closing * h:  # the impact that the first step skips is never made up for
            x, v = x0 + t[:, None] * v0, np.broadcast_to(v0, x.shape).copy()
        return t, x, v
    """,
).edit("simulate_head_on", {"0 < closing and gap <=": "0 < closing and 0 < xb - xa - 2 * radius <="})
mistakes(
    "LAUNCH_IGNORED",
    "A ball that starts on the floor and moves upwards does not fly.",
    "A ball that starts on the floor with v0 > g h flies off, although it touches the floor.",
).edit("simulate_drop", {"resting = False": "resting = z0 <= radius"})
mistakes(
    "VELOCITIES_LATE",
    "The positions are right; the velocities at the first sample after the impact are still the old ones.",
    "Row i of both belongs to the time i h: store the velocity after the step beside the position after the step.",
).edit("simulate_head_on", {"return t, x, v": "return t, x, np.vstack((v[:1], v[:-1]))"})
mistakes(
    "RESTS_ELSEWHERE",
    "The ball comes to rest, but not at z = radius.",
    "z is the height of its centre: at rest z = radius and v = 0, in every row up to the last.",
).edit(
    "simulate_drop",
    {"= radius, 0.0": "= z[i], 0.0", "= radius + (0.0 if resting else ": "= z[i] if resting else radius + ("},
)
mistakes(
    "ONLY_WITHOUT_REBOUND",
    "Of these pairs, only those are wrong where e is zero.",
    "Zero is a restitution like any other: `restitution or 1.0`, for example, would replace it. The factor is 1 + e.",
    kind="consequence",
).edit("impulse_1d", {"- vb, restitution)": "- vb, restitution or 1.0)"})
mistakes(
    "ONLY_VERY_UNEQUAL",
    "Of these pairs, only those are wrong where one body is many thousand times as heavy as the other.",
    "The formula holds for all masses: take no heavy body for a wall.",
    kind="consequence",
).body(
    "impulse_1d",
    """
        if max(ma, mb) > 1e4 * min(ma, mb):
            ma = mb = 2 * min(ma, mb)
        return _impulse(ma, mb, va - vb, restitution)
    """,
)
mistakes(
    "ONLY_NEARLY_EQUAL",
    "Of these pairs, only those are wrong whose masses differ by less than one per cent.",
    "The formula holds for all masses: use each as it is given, without a special case.",
    kind="consequence",
).around("resolve", "return _right(ma, ma if abs(ma - mb) < 0.01 * ma else mb, va, vb, normal, restitution)")
mistakes(
    "WALL_ASSUMED_AT_REST",
    "The wall's own velocity does not count: the result is that of a wall at rest.",
    "A wall may move, as a piston does: s = (va - vb) . n holds for it, too.",
    kind="consequence",
).around(
    "resolve",
    """
        if np.isinf(ma):
            return va, _right(ma, mb, 0 * va, vb, normal, restitution)[1]
        if np.isinf(mb):
            return _right(ma, mb, va, 0 * vb, normal, restitution)[0], vb
        return _right(ma, mb, va, vb, normal, restitution)
    """,
)
mistakes(
    "WALLS_SMOOTH",
    "Against a wall there is no friction.",
    "Walls rub like other bodies: Jt = min(mu J, |vt| / (1/ma + 1/mb)), where one over infinity is zero.",
    kind="consequence",
).around(
    "resolve_with_friction",
    "return _right(ma, mb, va, vb, normal, restitution, 0.0 if math.inf in (ma, mb) else mu)",
)
mistakes(
    "OVERLAP_IN_THE_PAST",
    "For spheres that overlap already and approach, your code returns a time before the start.",
    "Where |x| < R and they approach, they touch now: the answer is 0.0.",
    kind="consequence",
).edit(
    "time_of_impact",
    {
        "    if c <= 0:\n        return 0.0\n": "",
        "c / (b + math.sqrt(b * b - a * c))": "(b - math.sqrt(b * b - a * c)) / a",
    },
)
mistakes(
    "SHORT_HOP_MISSED",
    "A ball that rises and is back on the floor within one step goes into the floor.",
    "Where the parabola ends decides whether the ball touches, whatever v is at its start.",
).edit(
    "simulate_drop",
    {"radius:  # a parabola that starts above the floor crosses it once": "radius and v[i] <= 0:"},
)
mistakes(
    "REST_KEEPS_SPEED",
    "The ball lies on the floor, but its velocity is not zero there.",
    "At rest both are fixed: z = radius and v = 0, in the row after the contact and in all later ones.",
).around(
    "simulate_drop",
    """
        t, z, v = _right(z0, v0, radius, restitution, g, t_end, h)
        still = (v == 0.0) & (z == radius) & (t > 0)
        return t, z, np.where(still, 0.3 * g * h, v)
    """,
)
mistakes(
    "EULER_IN_PARTS",
    "Before the first contact the fall has the error of Euler steps that are shorter than h.",
    "Shorter steps have a smaller error, but free flight has an exact step: z + v h - g h**2 / 2 for the height and v - g h for the velocity.",
    kind="consequence",
).body(
    "simulate_drop",
    """
        n, parts = round(t_end / h), 200
        z, v, rest = z0, v0, False
        zs, vs = [z], [v]
        for i in range(n):
            for _ in range(parts):
                if rest:
                    break
                v = v - g * h / parts
                z = z + v * h / parts
                if z <= radius and v < 0:
                    rest = -v <= g * h
                    z, v = radius, -restitution * v
            if rest:
                z, v = radius, 0.0
            zs.append(z)
            vs.append(v)
        return h * np.arange(n + 1), np.array(zs), np.array(vs)
    """,
)
mistakes(
    "OTHER_GRAVITY",
    "From the start the ball falls with another g than the one that is given.",
    "Use the argument g everywhere: in the flight, for the time to the floor, and in the rule for the rest.",
).around("simulate_drop", "return _right(z0, v0, radius, restitution, 9.81, t_end, h)")
mistakes(
    "NORMAL_REVERSED_AT_TIMES",
    "In some cases the normal points the other way.",
    "The normal points from a to b wherever they are and however deep they overlap: (xb - xa) over its length. A plane's normal is the one you are given, also for a centre below it.",
).around(
    "detect_sphere_sphere",
    """
        touching, normal, depth = _right(xa, ra, xb, rb)
        return touching, -normal if depth > min(ra, rb) else normal, depth
    """,
)
mistakes(
    "FRICTION_TOO_STRONG",
    "Friction takes too much of the slip. Along the normal all is right.",
    "Jt = min(mu J, |vt| / (1/ma + 1/mb)), for every mu. Compute both by hand for one pair: which of them does your friction exceed?",
    kind="consequence",
).around("resolve_with_friction", "return _right(ma, mb, va, vb, normal, restitution, mu or 0.5)")
mistakes(
    "VELOCITIES_APART",
    "The positions are right, and the velocities beside them are wrong.",
    "Row i of both belongs to the time i h. Store the velocity that the step computes, with its sign; a difference of two positions is the mean of a whole step.",
    kind="consequence",
).around(
    "simulate_head_on",
    """
        t, x, v = _right(m, x0, v0, radius, restitution, t_end, h)
        v[1:] = np.diff(x, axis=0) / h
        return t, x, v
    """,
)
mistakes(
    "FLIGHT_WRONG",
    "The heights are wrong before the ball has bounced at all.",
    "In the air nothing happens but gravity: z + v h - g h**2 / 2 for the height and v - g h for the velocity, whatever the height is.",
    kind="consequence",
).body(
    "simulate_drop",
    """
        n = round(t_end / h)
        t, z, v = h * np.arange(n + 1), np.empty(n + 1), np.empty(n + 1)
        z[0], v[0] = z0, v0
        for i in range(n):
            a = -g - 0.05 * v[i] * abs(v[i])
            z[i + 1], v[i + 1] = z[i] + v[i] * h + a * h * h / 2, v[i] + a * h
            if z[i + 1] < radius:
                z[i + 1], v[i + 1] = radius, restitution * abs(v[i + 1])
        return t, z, v
    """,
)
mistakes(
    "ONLY_EQUAL",
    "Of these pairs, only those with two equal masses are wrong.",
    "The formula holds for all masses, without a special case. Equal bodies exchange their velocities only for e = 1.",
    kind="consequence",
).around("resolve", "return _right(ma, mb, va, vb, normal, 1.0 if ma == mb else restitution)").around(
    "impulse_1d", "return _right(ma, mb, va, vb, 1.0 if ma == mb else restitution)"
)
mistakes(
    "QUADRATIC_MIXED",
    "Two forms of the quadratic formula are mixed: the one with b = x . v, and the one with b = 2 x . v.",
    "With b = x . v the root is (-b - sqrt(b**2 - a c))/a; with b = 2 x . v it is (-b - sqrt(b**2 - 4 a c))/(2 a).",
).edit(
    "time_of_impact",
    {
        "v @ v, nearing": "v @ v, 2 * nearing",
        "c / (b + math.sqrt(b * b - a * c))": "(b - math.sqrt(b * b - a * c)) / (2 * a)",
    },
)
mistakes(
    "FALL_WITHOUT_TWO",
    "On the way down v**2 grows by something other than 2 g (z - radius).",
    "The speed at the floor is sqrt(v**2 + 2 g (z - radius)).",
).edit("simulate_drop", {"* 2 + 2 * g * max(": "* 2 + g * max("})
mistakes(
    "DISTANCE_BY_COORDINATES",
    "The distance of the centres leaves out a coordinate, or adds or compares the coordinates one by one.",
    "It is the length of xb - xa: the root of the sum of the squares of all its coordinates, np.linalg.norm(xb - xa).",
).edit("detect_sphere_sphere", {"np.linalg.norm(apart)": "np.linalg.norm(apart[:2])"})
mistakes(
    "DISTANCE_WRONG",
    "The same wrong distance of the centres is in the depth and in the normal.",
    "The distance is the length of xb - xa: the root of the sum of the squares of all its coordinates, np.linalg.norm(xb - xa).",
).edit("detect_sphere_sphere", {"np.linalg.norm(apart)": "abs(np.linalg.norm(xb) - np.linalg.norm(xa))"})
mistakes(
    "NORMAL_NOT_UNIT",
    "The normal is not a unit vector: its length is not one.",
    "Divide the vector between the centres by its length; a plane's normal already has length one. Where the centres coincide, any vector will do whose length is one.",
)
mistakes(
    "HEIGHT_ALONG_AN_AXIS",
    "The height above the plane is measured along an axis, not along the normal.",
    "The height is the dot product (x - point) . normal, with no division.",
)
mistakes(
    "DEPTH_ALONG_AN_AXIS",
    "The depth is measured along an axis, not along the normal.",
    "depth = r - (x - point) . normal, with no division.",
)
mistakes(
    "DEPTH_UNSIGNED",
    "The depth has lost its sign: it is positive where the bodies are apart, too.",
    "Return it with its sign, without abs(): negative where they are apart.",
)
mistakes(
    "TOUCHING_INVERTED",
    "touching is True where the bodies are apart, and False where they overlap.",
    "Bodies touch where the depth is zero or more.",
)
mistakes(
    "DISTANCE_SQUARED",
    "The square of a length, or its square root, is used where the length itself belongs.",
    "The depth is ra + rb - distance, or r - height, all in metres. The distance is the length of xb - xa, with one square root in all; the height is a dot product, with none.",
)
mistakes(
    "WAY_TO_CONTACT_MISSING",
    "In the step of the impact the balls do not move up to the contact: that part of their way is left out.",
    "For the time to the contact they move with their old velocities, for the rest of the step with the new ones.",
).edit(
    "simulate_head_on",
    {
        "xa, xb = xa + va * wait, xb + vb * wait": "xa, xb = (xa + va * wait, xb + vb * wait) if wait == h else (xa, xb)"
    },
)
mistakes(
    "ONE_RADIUS_BETWEEN",
    "The balls meet where their centres are one radius apart.",
    "Each of them reaches one radius from its centre: at contact the centres are two radii apart.",
).edit("simulate_head_on", {"xb - xa - 2 * radius": "xb - xa - radius"})
mistakes(
    "ONE_RADIUS_ONLY",
    "Only one of the two radii is used.",
    "The centres are ra + rb apart at contact: both bodies have a size.",
)
mistakes(
    "RADIUS_ADDED_TWICE",
    "A radius is counted twice.",
    "Count each radius once: the centres are ra + rb apart at contact, and a sphere reaches r below its centre.",
)
mistakes(
    "DISTANCE_TO_POINT",
    "The distance to the given point of the plane counts, not the one to the plane itself.",
    "Only the part of x - point along the normal counts: take the dot product.",
)
mistakes(
    "SOLID_ON_THE_WRONG_SIDE",
    "The side that the normal points to is taken for the solid one.",
    "The normal points out of the solid: depth = r - (x - point) . normal.",
)
mistakes(
    "ALWAYS_TOUCHES",
    "touching is True also where the bodies are apart.",
    "Bodies touch where the depth is zero or more, and nowhere else.",
)
mistakes(
    "NEVER_TOUCHES",
    "touching is False also where the bodies overlap.",
    "Bodies touch where the depth is zero or more.",
)
mistakes(
    "NORMAL_PER_AXIS",
    "Single coordinates are used where the whole vector belongs: absolute values, signs, or a length that is not the vector's.",
    "Work with whole vectors: the difference of two positions, the dot product, the Euclidean length.",
)
mistakes(
    "DEPTH_HALVED",
    "The depth comes out half as large as it should be.",
    "depth = ra + rb - distance (or r - height): the whole overlap, not half of it for each body.",
)
mistakes(
    "DEPTH_AS_SHARE",
    "The depth is returned as a fraction of some length, not as a length.",
    "The depth is in metres: ra + rb - distance, or r - height. Do not divide it by anything.",
)
mistakes(
    "DISTANCE_IGNORED",
    "The depth does not depend on where the bodies are.",
    "Subtract the distance between the centres, or the height above the plane.",
)
mistakes(
    "RADII_SUBTRACTED",
    "One radius is subtracted from the other.",
    "Add the radii: at contact the centres are ra + rb apart.",
)
mistakes(
    "RADII_HALVED",
    "The radii are halved, as if they were diameters.",
    "A radius reaches from the centre to the surface, so use ra + rb, or r, as they are.",
)
mistakes(
    "RADII_MULTIPLIED",
    "The radii are multiplied.",
    "Add the radii: at contact the centres are ra + rb apart.",
)
mistakes(
    "RADIUS_SIGN_FLIPPED",
    "The radius has the wrong sign, so a larger sphere overlaps less instead of more.",
    "depth = r - height: the sphere reaches r below its centre.",
)
mistakes(
    "CENTRE_IGNORED",
    "The height does not depend on where the sphere is.",
    "The height of the centre is (x - point) . normal.",
)
mistakes(
    "LENGTH_OF_THE_POINT",
    "The length of `point` is subtracted, where its part along the normal belongs.",
    "The plane goes through `point`: the height of the centre is (x - point) . normal.",
)
mistakes(
    "TOUCHING_WRONG",
    "The normal and the depth are right, but touching is not.",
    "touching is depth >= 0, and nothing else: however deep, however far, on whichever side.",
    kind="consequence",
)
mistakes(
    "PRECISION_LOST",
    "The result is right to about six digits, and not to nine.",
    "Compute in float64 throughout, without float32, rounding, or a small constant that is added somewhere.",
    kind="consequence",
)
mistakes(
    "NORMAL_IS_ZERO",
    "A normal is the zero vector.",
    "A normal has length one. Where the centres coincide, return any unit vector, such as the first axis.",
    kind="fact",
)
mistakes(
    "RESTITUTION_IGNORED",
    "The bodies part as if the restitution were one, or as if it were zero.",
    "The impulse has the factor 1 + e: the 1 stops the approach, and the e sends them apart again. A ball leaves the floor with e times its speed, and rests only if that speed, without its sign, is at most g h.",
    kind="consequence",
)
mistakes(
    "ONLY_THE_REBOUND",
    "The impulse is proportional to e, where the factor 1 + e belongs.",
    "An impact first stops the approach (that is the 1) and then drives the bodies apart (that is the e): together 1 + e.",
)
mistakes(
    "RESTITUTION_SIGN_FLIPPED",
    "The impulse has the factor 1 - e: the bounciest bounce the least.",
    "The bodies turn round: going from approaching at speed s to separating at e s is a change of (1 + e) s.",
)
mistakes(
    "MEAN_MASS",
    "The impulse is computed with the mean of the two masses, or with half of it.",
    "J = (1 + e) s / (1/ma + 1/mb): the inverses add up. Try masses of 1 kg and 3 kg.",
)
mistakes(
    "ONE_MASS_ONLY",
    "Only one of the masses is used in the impulse, as if the other body were a wall.",
    "Both velocities change, so divide by 1/ma + 1/mb.",
)
mistakes(
    "MASSES_IGNORED",
    "The masses are left out of the impulse, or of what it does to the velocities.",
    "The same impulse changes the velocity of a heavy body less: J = (1 + e) s / (1/ma + 1/mb), and each velocity changes by J/m.",
)
mistakes(
    "ONLY_HEAD_ON",
    "A body that catches up with one that moves away from it gets no impulse.",
    "They approach where va - vb (in space: its component along n) is positive, whichever way each of them moves.",
)
mistakes(
    "IMPULSE_REVERSED",
    "The impulse has the wrong sign: it pulls the bodies into each other, faster than before.",
    "J is positive where the bodies approach. Body a loses J n and body b gains it: va - J/ma n, vb + J/mb n.",
)
mistakes(
    "SPEED_NOT_ALONG_NORMAL",
    "Your code uses whole speeds where only their component along the normal belongs.",
    "The speed of approach is the dot product (va - vb) . n.",
)
mistakes(
    "RETURNS_SWAPPED",
    "Your code returns the right two velocities in the wrong order.",
    "Return (va_next, vb_next): first the velocity of a, then that of b.",
)
mistakes(
    "NO_RESPONSE",
    "Here bodies that run into each other get no impulse.",
    "Where (va - vb) . n > 0 (on a line: va > vb), the impulse is J = (1 + e) s / (1/ma + 1/mb), and each velocity changes by its share of it.",
    kind="consequence",
)
mistakes(
    "ENERGY_CREATED",
    "Here an impact adds kinetic energy, which no impact can.",
    "Compute this impact by hand and compare: J from the velocities before the impact, then both velocities with this one J.",
    kind="consequence",
)
mistakes(
    "WALL_MOVED",
    "The wall's velocity changes.",
    "An impulse changes the velocity of a wall by J / inf, which is 0.0: it goes on as before. If your code divides so, see in which order it returns the two, and that nothing else sets the velocity of a wall.",
    kind="consequence",
)
mistakes(
    "FRICTION_ASKEW",
    "Here friction does not act along the slip, and along the normal all is right.",
    "vt is a vector, and so is friction: Jt times -vt / |vt| on b, in three dimensions as in two.",
    kind="consequence",
)
mistakes(
    "FRICTION_NOT_UNIT",
    "Friction is multiplied by the slip vt itself, not by its direction.",
    "Divide vt by its length: Jt times -vt / |vt|.",
)
mistakes(
    "FRICTION_TURNS_THE_SLIP",
    "Friction turns the slip round. Along the normal all is right.",
    "Jt = min(mu J, |vt| / (1/ma + 1/mb)): the second value stops the slip, and friction never does more.",
    kind="consequence",
)
mistakes(
    "FRICTION_TOO_WEAK",
    "Friction takes too little of the slip. Along the normal all is right.",
    "Jt = min(mu J, |vt| / (1/ma + 1/mb)), however slow the slip is, with nothing added to its length. Compute both by hand for one pair, and compare your friction with the smaller.",
    kind="consequence",
)
mistakes(
    "BLOW_TOO_WEAK",
    "The bodies do not separate at e times the speed of approach: they are slower, or still approach.",
    "After the impact, (va - vb) . n must be -e times what it was before. Check it for one pair by hand.",
    kind="consequence",
)
mistakes(
    "MOMENTUM_LOST",
    "The total momentum changes, although no outside force acts.",
    "Both bodies get the same impulses, with opposite signs, each divided by its own mass, and nothing else changes va or vb. Compute both changes by hand and compare.",
    kind="consequence",
)
mistakes(
    "DEPENDS_ON_THE_FRAME",
    "The same impact, seen from a moving train, gives a different result.",
    "Only the difference va - vb counts. Does one velocity enter the impulse by itself, in a formula or in a condition?",
    kind="consequence",
)
mistakes(
    "DEPENDS_ON_DIRECTION",
    "The same impact, rotated or mirrored, gives a different result.",
    "Work with whole vectors, dot products with n and multiples of n, and never with single coordinates.",
    kind="consequence",
)
mistakes(
    "ONE_DIMENSION_ONLY",
    "A number of coordinates is taken for granted.",
    "Work with whole vectors of any length: a @ b, a - b, and for friction the slip vt = u - (u . n) n instead of a tangent (-n[1], n[0]).",
    kind="fact",
)
mistakes(
    "RESTITUTION_DOUBLED",
    "The rebound is counted twice, or one is added to it.",
    "The impulse of two bodies that meet has the factor 1 + e: 1 stops the approach, e sends them apart. A ball leaves the floor with e times its speed.",
)
mistakes(
    "RESTITUTION_HALVED",
    "Only half of the rebound is counted.",
    "The impulse of two bodies that meet has the factor 1 + e: 1 stops the approach, e sends them apart. A ball leaves the floor with e times its speed.",
)
mistakes(
    "MASS_SUM_ROOTED",
    "The two masses are combined with a square root.",
    "J = (1 + e) s / (1/ma + 1/mb): add the inverse masses.",
)
mistakes(
    "MASSES_SUBTRACTED",
    "The masses, or their inverses, are subtracted from each other.",
    "Both velocities change, so add the inverse masses: 1/ma + 1/mb.",
)
mistakes(
    "MASSES_SWAPPED",
    "Each body gets the change of velocity that belongs to the other: the masses are swapped.",
    "The velocity of a changes by J/ma and that of b by J/mb, each with its own mass.",
)
mistakes(
    "SPEED_UNSIGNED",
    "The speed of approach has lost its sign, so bodies that move apart get an impulse as if they collided.",
    "Take va - vb with its sign (in space: its component along n) and act only where it is positive.",
    true_too=("IMPULSE_ON_SEPARATING",),
)
mistakes(
    "SPEED_SQUARED",
    "The impulse is not proportional to the speed of approach.",
    "J is proportional to s. It is the energy that goes with the square of the speed.",
)
mistakes(
    "SPEED_IGNORED",
    "The impulse does not depend on how fast the bodies approach.",
    "J = (1 + e) s / (1/ma + 1/mb) with s = va - vb.",
)
mistakes(
    "IMPULSE_HALVED",
    "The impulse is half of what it should be.",
    "J = (1 + e) s / (1/ma + 1/mb), and all of it acts on each body. Look for a factor of 2: in a mean of the masses, beside 1 + e, or in an impulse that you split between the bodies.",
)
mistakes(
    "IMPULSE_DOUBLED",
    "The impulse is twice what it should be.",
    "J = (1 + e) s / (1/ma + 1/mb), once on each body. Look for a factor of 2: in a mean of the masses, or beside 1 + e.",
)
mistakes(
    "IMPULSE_AS_VELOCITY",
    "The result is a change of velocity, in m/s, and not the impulse.",
    "Return J itself, in N s. What it does to a velocity is J/m, and resolve divides it there.",
)
mistakes(
    "PARENTHESES_MISSING",
    "Only the first part of 1/ma + 1/mb divides; the second is added to the result.",
    "Put the sum in parentheses: (1 + e) * s / (1 / ma + 1 / mb).",
)
mistakes(
    "BLOW_PER_AXIS",
    "The impact acts coordinate by coordinate instead of along the normal.",
    "Add and subtract multiples of the vector n itself: va - J/ma n, vb + J/mb n.",
)
mistakes(
    "ACROSS_NOT_KEPT",
    "The components of the velocities across the normal are lost.",
    "Start from va and vb as they are, and add the changes to them: the impulse along n and, between rough bodies, friction across it.",
)
mistakes(
    "ALONG_NOT_KEPT",
    "The components of the velocities along the normal are replaced instead of changed.",
    "Start from va and vb as they are, and add the change: va - J/ma n, vb + J/mb n.",
)
mistakes(
    "ELASTIC_EXCHANGE",
    "The bodies exchange their velocities along the normal. That is right only for equal masses and e = 1.",
    "J = (1 + e) s / (1/ma + 1/mb); each velocity changes by J over its own mass.",
)
mistakes(
    "PERFECTLY_STICKY",
    "Both bodies move on with the same velocity, as if they stuck together.",
    "Along the normal the bodies part at e times the speed of approach. Across it nothing but friction changes their velocities.",
)
mistakes(
    "SOME_PAIRS_SPARED",
    "Some bodies that approach keep their velocities; the other pairs that approach are right.",
    "Every pair with (va - vb) . n > 0 gets its impulse, however slow it is, whichever of the two moves, with friction or without.",
    kind="consequence",
)
mistakes(
    "ONE_BODY_RIGHT",
    "The velocity of one body is right in every pair, and that of the other is not.",
    "Both come from the same J and from the velocities before the impact: compare the line of the wrong one with that of the right one.",
    kind="consequence",
)
mistakes(
    "APPROACH_BY_ONE_BODY",
    "Whether they approach is decided by the velocity of one body, by the signs of both velocities, or by their speeds.",
    "They approach where (va - vb) . n > 0 (on a line: va > vb), whichever of them moves.",
)
mistakes(
    "IMPULSE_COMPUTED_TWICE",
    "The second velocity is computed from the first one after that has changed.",
    "Compute J once, from the velocities before the impact, and then both new velocities with it.",
)

# -- friction

mistakes(
    "FRICTION_SPINS",
    "Where friction could stop the slip, it stops only the part that it would on a body that begins to roll.",
    "These bodies do not spin: the impulse that stops the slip is |vt| / (1/ma + 1/mb), all of it.",
)
mistakes(
    "FRICTION_IGNORED",
    "Your code applies no friction.",
    "A second impulse acts across the normal, against the slip: at most mu J, and no more than it takes to stop the slip. If you have it, print J there: it is computed from the velocities before the impact, as the slip is.",
)
mistakes(
    "FRICTION_TAKES_THE_LARGER",
    "Your code takes the larger of the two limits of friction.",
    "Both are upper limits: min(mu J, |vt| / (1/ma + 1/mb)).",
)
mistakes(
    "STICKING_WITHOUT_MASS",
    "The impulse that stops the slip is computed without the masses, or with the masses in a wrong form.",
    "The impulse that stops the slip is |vt| / (1/ma + 1/mb), in N s like mu J.",
)
mistakes(
    "FRICTION_PROPORTIONAL",
    "Friction grows with the speed of the slip, as it would in thick oil.",
    "Coulomb friction does not depend on the speed: it is mu J against the slip, unless less is enough to stop it.",
)
mistakes(
    "FRICTION_NOT_ACROSS",
    "The slip still contains some of the relative velocity along the normal.",
    "Subtract the normal component first: u - (u . n) n with u = vb - va.",
)
mistakes(
    "FRICTION_WITHOUT_REBOUND",
    "The limit is mu times an impulse that leaves out the rebound.",
    "The surfaces press on each other during the whole impact, so the J in mu J contains the factor 1 + e.",
)
mistakes(
    "FRICTION_HALVED",
    "The friction impulse, or its limit, is half of what it should be.",
    "Jt = min(mu J, |vt| / (1/ma + 1/mb)), and all of it acts on each body.",
)
mistakes(
    "FRICTION_DOUBLED",
    "Coulomb's limit is twice as large as it should be.",
    "The limit is mu J, counted once.",
)
mistakes(
    "FRICTION_COEFFICIENT_SQUARED",
    "The coefficient of friction is squared.",
    "Coulomb's limit is mu J, with the coefficient as it is given.",
)
mistakes(
    "FRICTION_WITHOUT_MU",
    "The limit of friction does not depend on the coefficient of friction.",
    "The friction impulse is at most mu J.",
)
mistakes(
    "FRICTION_STOPS_HALF_THE_SLIP",
    "Where friction could stop the slip, it removes only half of it.",
    "The impulse that stops the slip is |vt| / (1/ma + 1/mb); use all of it.",
)
mistakes(
    "FRICTION_STOPS_TWICE_THE_SLIP",
    "Where friction should stop the slip, it reverses it.",
    "The impulse that stops the slip is |vt| / (1/ma + 1/mb); use no more than that.",
)
mistakes(
    "FRICTION_ALL_OR_NOTHING",
    "Friction either stops the slip or does nothing at all.",
    "Where mu J is not enough to stop the slip, friction still acts, with mu J.",
)
mistakes(
    "FRICTION_WITHOUT_BLOW",
    "The limit of friction does not depend on how hard the bodies press on each other.",
    "Coulomb's limit is mu times J, where J is the impulse along the normal.",
)
mistakes(
    "FRICTION_OF_A_SPEED",
    "Coulomb's limit is computed as mu times a speed instead of mu times the impulse J.",
    "Jt = min(mu J, |vt| / (1/ma + 1/mb)), where J is the impulse along the normal, in N s, so the masses are in it.",
)
mistakes(
    "NEVER_FINDS_A_CONTACT",
    "Your code returns None for every pair tried here, also for those that meet.",
    "Where spheres that are apart approach and pass closely enough, return the smaller root of |dx + dv t| = ra + rb, with dv the difference of both velocities, if it is at most dt. If they overlap already and approach, return 0.0.",
    kind="consequence",
)
mistakes(
    "IMPACT_IN_THE_PAST",
    "A contact that lies in the past is reported: of bodies that already move apart, or of bodies that overlap.",
    "Return None unless the bodies approach, that is unless the distance between their centres is shrinking now. If they overlap and approach, return 0.0.",
    kind="consequence",
)
mistakes(
    "OVERLAP_IGNORED",
    "Bodies that already overlap and still approach are not reported as touching now.",
    "Test for this first: if they overlap and approach, the contact is at 0.0.",
)
mistakes(
    "RETURNS_SHARE_OF_STEP",
    "Your code returns a fraction of the step instead of a time in seconds.",
    "Multiply by dt: the answer is the time from the start of the step, in seconds.",
)
mistakes(
    "RETURNS_TIME_LEFT",
    "Your code returns the time that is left in the step after the contact.",
    "Return the time from the start of the step to the contact.",
)
mistakes(
    "NO_RELATIVE_MOTION",
    "Where both bodies have the same velocity the result is nan: zero is divided by zero.",
    "Two bodies at rest relative to each other do not approach: return None before you divide.",
    kind="nan",
)
mistakes(
    "ROOT_OF_A_NEGATIVE",
    "Where the bodies pass beside each other the result is nan, and not None.",
    "There the number under the square root is negative: test it before you take the root, and return None.",
    kind="nan",
)
mistakes(
    "CLOSEST_APPROACH",
    "Your code returns the time at which the centres are closest. The surfaces touch earlier.",
    "Subtract the square root's part, sqrt(b**2 - a c)/a.",
)
mistakes(
    "ROOT_HALVED",
    "Only half of the square root's part is subtracted, so the contact comes too late.",
    "t = (b - sqrt(b**2 - a c))/a for a t**2 - 2 b t + c = 0: compare your factors of 2 and 4 with that.",
)
mistakes(
    "ROOT_DOUBLED",
    "Twice the square root's part is subtracted, so the contact comes too early.",
    "t = (b - sqrt(b**2 - a c))/a for a t**2 - 2 b t + c = 0: compare your factors of 2 and 4 with that.",
)
mistakes(
    "ROOT_TERM_WRONG",
    "The square root's part is wrong: the root is not taken, or not divided by v . v exactly once.",
    "t = (b - sqrt(b**2 - a c))/a with a = v . v: the whole square root is divided by a, once.",
)
mistakes(
    "MIDDLE_TERM_WRONG",
    "The term before the square root is wrong. It is the time of closest approach, -(x . v)/(v . v).",
    "t = (b - sqrt(b**2 - a c))/a with b = -(x . v) and a = v . v.",
)
mistakes(
    "RETURNS_THE_STEP",
    "The time of a contact comes out as the start or the end of the step.",
    "Return the root itself: the time from now to the contact.",
)
mistakes(
    "TIME_NEGATED",
    "The time has the wrong sign.",
    "The contact lies ahead, so the time is positive. Check the signs of x = xb - xa and v = vb - va, and those in the formula of the root.",
)
mistakes(
    "MOTION_REVERSED",
    "Bodies that move apart get a time of contact, and those that approach get None.",
    "Check the signs: x = xb - xa, v = vb - va, and bodies approach where x . v is negative.",
)
mistakes(
    "MISS_NOT_SEEN",
    "Bodies that pass beside each other get a time, as if they met: a negative number under the square root is made positive, or zero.",
    "Test that number before you take its root: if it is negative, the bodies never touch, so return None.",
)
mistakes(
    "MOTION_NOT_RELATIVE",
    "The motion is not that of b as seen from a, but that of one body alone, or the sum of both.",
    "Both spheres may move: v = vb - va.",
)
mistakes(
    "MOMENT_IN_STEP_WRONG",
    "The velocities after the impact are right, but the balls are where an impact at another moment of the step would take them.",
    "The time to the contact is the gap over the speed of approach, va - vb. For the rest of the step, h less that time, both balls move with their new velocities.",
)
mistakes(
    "TIME_LEFT_WRONG",
    "After the impact the bodies move on for too long or too short a time: the instant of the impact, or what is left of the step, is wrong.",
    "A contact at time s into the step leaves h - s, where s comes from the velocities before the impact.",
)
mistakes(
    "OLD_VELOCITY_AFTER",
    "For the rest of the step one ball still moves with its old velocity.",
    "Compute both new velocities first, then move both balls with them.",
)
mistakes(
    "SPEED_AT_STEP_END",
    "The ball leaves the floor with e times the speed that it would have at the end of the step.",
    "Take the speed at the floor: sqrt(v**2 + 2 g (z - radius)), from the start of the step.",
)
mistakes(
    "FALLS_THROUGH_FLOOR",
    "The ball falls through the floor as if it were not there.",
    "In each step, ask whether the centre comes down to z = radius within it. If so, move to the contact and bounce there. If your code does so, print its time to the floor: it is (v + speed)/g, with v upwards.",
)
mistakes(
    "SPEED_AT_STEP_START",
    "The ball leaves the floor with e times the speed that it had at the start of the step.",
    "On the way to the floor it gets faster: its speed there is sqrt(v**2 + 2 g (z - radius)).",
)
mistakes(
    "FALLS_TO_ZERO",
    "The speed at the floor is that of a centre which falls to z = 0.",
    "The ball touches at z = radius: its speed there is sqrt(v**2 + 2 g (z - radius)).",
)
mistakes(
    "GAINS_ENERGY",
    "After its first contact the ball has more energy than it had before.",
    "It leaves the floor with e times the speed it has at the floor, sqrt(v**2 + 2 g (z - radius)), and flies on for the rest of the step, slowed by gravity.",
    kind="consequence",
)
mistakes(
    "LAUNCH_IS_BOUNCE",
    "A ball that starts on the floor and moves upwards leaves it with e times its speed, as if it had just fallen on it.",
    "The start is not a contact: a ball that moves upwards flies off with v0.",
)
mistakes(
    "ROWS_ALL_THE_SAME",
    "All rows hold the same state, and it is not the initial one.",
    "Write into row i alone, or append a copy. x[:] = ... fills every row, and an array that is appended again and again and changed in between ends up in all rows.",
)
mistakes(
    "HISTORIES_SWAPPED",
    "The positions and the velocities are returned in each other's place.",
    "Return the times first, then the positions, then the velocities: (t, x, v), or (t, z, v) for the drop.",
).edit("simulate_head_on", {"return t, x, v": "return t, v, x"}).edit(
    "simulate_drop", {"return t, z, v": "return t, v, z"}
)
mistakes(
    "VELOCITIES_UNSIGNED",
    "The velocities have lost their signs.",
    "A velocity downwards, or to the left, is negative: store it as it is, without abs().",
).edit("simulate_head_on", {"return t, x, v": "return t, x, np.abs(v)"}).edit(
    "simulate_drop", {"return t, z, v": "return t, z, np.abs(v)"}
)
mistakes(
    "BOUNCE_SPEED_KEPT",
    "In the step of a bounce the stored velocity is the one with which the ball leaves the floor, not the one at the end of the step.",
    "It flies on for the rest of the step, and gravity slows it: v = up - g * left.",
).edit("simulate_drop", {"up - g * left\n": "up\n"})
mistakes(
    "ROWS_NOT_WRITTEN",
    "The last rows, or the last one, hold nothing but zeros.",
    "N steps fill the rows 1 to N: run the loop N times, and write the state into row i + 1 in each of them, also after a contact and at rest.",
    kind="consequence",
).edit(
    "simulate_head_on",
    {
        "for i in range(n):": "for i in range(n - 1):",
        "np.empty((n + 1, 2)), np.empty": "np.zeros((n + 1, 2)), np.zeros",
    },
).edit(
    "simulate_drop",
    {
        "for i in range(n):": "for i in range(n - 1):",
        "np.empty(n + 1), np.empty": "np.zeros(n + 1), np.zeros",
    },
)
mistakes(
    "INITIAL_STATE_WRONG",
    "The first row is not the initial state.",
    "Row 0 holds the positions and velocities as they were given, before any step. An array that is stored and changed later changes in its row, too: store a copy.",
)
mistakes(
    "REST_OF_STEP_WITHOUT_GRAVITY",
    "After the bounce, the rest of that step is computed without gravity.",
    "The rest of the step is free flight like any other: z = radius + up * left - g * left**2 / 2 and v = up - g * left.",
)
mistakes(
    "ONE_BOUNCE_A_STEP",
    "A ball that bounces and is back on the floor within the same step goes into the floor.",
    "Bounce as often as it touches before the step ends, each time at its own instant, until it may rest.",
)
mistakes(
    "TIMES_NOT_AS_ROWS",
    "The other two have N + 1 rows, and t has another number of entries.",
    "t[i] is i * h for i from 0 to N: np.arange(N + 1) * h.",
).edit("simulate_head_on", {"h * np.arange(n + 1)": "np.arange(0, t_end, h)"}).edit(
    "simulate_drop", {"h * np.arange(n + 1)": "np.arange(0, t_end, h)"}
)
mistakes(
    "HISTORIES_TRANSPOSED",
    "Positions and velocities have one column for each sample instead of one row.",
    "Their shape is (N+1, 2): row i is the state at time i * h.",
).edit("simulate_head_on", {"return t, x, v": "return t, x.T, v.T"})
mistakes(
    "HEIGHTS_OF_THE_UNDERSIDE",
    "The heights are one radius too small: they are those of the ball's lowest point.",
    "z is the height of the centre. On the floor it is z = radius.",
).edit("simulate_drop", {"return t, z, v": "return t, z - radius, v"}).edit(
    "simulate_drop", {"return t, z, v": "z[1:] -= radius\n    return t, z, v"}
)
mistakes(
    "OFF_BY_ONE_SAMPLE",
    "There is one sample too many or one too few: n steps connect n + 1 states.",
    "N = round(t_end / h). Record the initial state before the loop and one state after each of the N steps.",
)
mistakes(
    "INITIAL_STATE_MISSING",
    "The first sample is not the initial state at time 0, in its time or in its state.",
    "Row 0 is the initial state, at t = 0. Row i is the state after i steps, at t = i h.",
)
mistakes(
    "FLOOR_TOO_HIGH",
    "The ball turns round before its surface reaches the floor.",
    "It touches where its centre is one radius above the floor, z = radius, at an instant inside the step: up to then it falls freely.",
)
mistakes(
    "DOWN_TOO_SOON",
    "The ball is put on the floor before it has fallen that far.",
    "From (z, v) it gets there after (v + speed)/g. If that is longer than what is left of the step, it is still in the air.",
)
mistakes(
    "REBOUND_COMPLEMENT",
    "The ball leaves the floor with 1 - e times its speed: the bounciest bounces the least.",
    "e is the share of the speed that is left: the ball leaves the floor with e times its speed.",
    true_too=("RESTS_TOO_EARLY",),
)
mistakes(
    "GRAVITY_WRONG",
    "In the air the ball is not accelerated by g downwards.",
    "Free flight over h gives z + v h - g h**2 / 2 and v - g h.",
    true_too=("OTHER_GRAVITY",),
)


formulas = kit.sibling(__file__, "formulas")


@mistakes.more
def hypotheses():
    """Task, codes of what is wrong, and function of each, those with one mistake first."""
    families = {task: (family, base, terms) for task, (family, base, terms) in formulas.TERMS.items()}
    families["simulate_head_on"] = _head_on, {}, _HEAD_ON
    families["simulate_drop"] = _drop, {}, _DROP
    several = (*families.items(), ("simulate_drop", (_hops, {}, _HOPS)))
    for again in (lambda s: max(s, 0.0), lambda s: s):
        yield "simulate_head_on", ("IMPULSE_COMPUTED_TWICE",), _head_on(again=again)
    for code, after in _AFTER:
        yield "simulate_head_on", (code,), _head_on(after=after)
    yield "simulate_head_on", ("WAY_TO_CONTACT_MISSING",), _head_on(goes=0.0)
    for code, straight in _DROP["straight"]:
        yield "simulate_drop", (code,), _drop(straight=straight, arrives=True)
    yield "simulate_drop", ("THROWN_DOWNWARDS",), _drop(starts=lambda v0: -v0)
    for rest in (
        lambda left, h: (left, left, h),
        lambda left, h: (left, h, left),
        lambda left, h: (h, left, left),
        lambda left, h: (left, h, h),
    ):
        yield "simulate_drop", ("STEP_FOR_THE_REST",), _drop(rest_of=rest)
    yield from (
        (task, codes, program) for task in families for codes, program in formulas.OTHERS.get(task, ())
    )
    for task, (family, base, terms) in several:
        for term, forms in terms.items():
            for code, form in forms:
                yield task, (code,), family(**base | {term: form})
    for task, (family, base, terms) in several:
        yield from _pairs(task, family, base, terms)
    yield "resolve", ("BLOW_NOT_ALONG_NORMAL", "RESTITUTION_IGNORED"), formulas.whole_vectors


def _pairs(task, family, base, terms):
    """Two terms wrong at once, each in the first form of its code."""
    firsts = {term: dict(reversed(forms)).items() for term, forms in terms.items()}
    names = list(terms)
    for number, one in enumerate(names):
        for other in names[number + 1 :]:
            for code, form in firsts[one]:
                for second, another in firsts[other]:
                    # Of another sign, a test that is meant for the depth says something else: see OTHERS.
                    signed = code.startswith(("DEPTH_SIGN", "DEPTH_CLAMPED", "DEPTH_UNSIGNED"))
                    if code != second and not (signed and other == "touching"):
                        yield task, (code, second), family(**base | {one: form, other: another})


def _head_on(
    factor=lambda e: 1 + e,
    give=lambda ma, mb: 1 / ma + 1 / mb,
    kick=lambda j, m, other: j / m,
    shares=(-1.0, 1.0),
    reach=lambda r: 2 * r,
    count=round,
    late=False,
    rest=1.0,
    passes=False,
    first=True,
    overlaps=False,
    clock=lambda i, h: i * h,
    slow=None,
    again=None,
    waits=lambda gap, va, vb: max(gap, 0.0) / (va - vb),
    leaves=lambda h, wait: h - wait,
    old=(),
    after=None,
    goes=1.0,
    over=lambda ma, mb: (ma, mb),
):
    """``late``: the impact comes at the sample after; ``rest``: what is flown of the rest of the step;

    ``old``: which balls fly it with their old velocities; ``again``: what is taken for the speed of approach
    where the second impulse is computed from the first new velocity; ``overlaps``: it acts only if the balls overlap at
    the end of the step; ``first``: keeps row 0.
    """

    def collide(m, va, vb, e):
        if after:
            return after(m, va, vb, e)
        if slow is not None and va - vb < slow:
            e = 0.0
        j, (of_a, of_b) = factor(e) * (va - vb) / give(*m), over(*m)
        va = va + shares[0] * kick(j, of_a, m[1])
        if again:
            j = factor(e) * again(va - vb) / give(*m)
        return va, vb + shares[1] * kick(j, of_b, m[0])

    def simulate(m, x0, v0, radius, e, t_end, h):
        n = count(t_end / h)
        (xa, xb), (va, vb) = x0, v0
        rows = [(xa, xb, va, vb)]
        for _ in range(n):
            gap, closing = xb - xa - reach(radius), va - vb
            meets = closing > 0 and gap <= closing * h and not passes
            if overlaps:
                meets = meets and abs(gap - closing * h + reach(radius)) <= reach(radius)
            if meets and late:
                xa, xb = xa + va * h, xb + vb * h
                va, vb = collide(m, va, vb, e)
            elif meets:
                wait = waits(gap, va, vb)
                xa, xb = xa + va * wait * goes, xb + vb * wait * goes
                before = va, vb
                va, vb = collide(m, va, vb, e)
                left = leaves(h, wait) * rest
                on = [before[ball] if ball in old else now for ball, now in enumerate((va, vb))]
                xa, xb = xa + on[0] * left, xb + on[1] * left
            else:
                xa, xb = xa + va * h, xb + vb * h
            rows.append((xa, xb, va, vb))
        rows = rows if first else rows[1:]
        t = [clock(i + (not first), h) for i in range(len(rows))]
        rows = np.array(rows).reshape(-1, 4)
        return np.array(t), rows[:, :2], rows[:, 2:]

    return simulate


def _scaled(m, va, vb, e, factor):
    """Both velocities after an impact, times e. factor: of the impulse, where 1 + e belongs."""
    j = factor * (va - vb) / (1 / m[0] + 1 / m[1])
    return e * (va - j / m[0]), e * (vb + j / m[1])


#: Velocities after the impact by another rule.
_AFTER = (
    ("MASSES_IGNORED", lambda m, va, vb, e: (va - (1 + e) * (va - vb) / 2, vb + (1 + e) * (va - vb) / 2)),
    ("MASSES_IGNORED", lambda m, va, vb, e: (va - (1 + e) * (va - vb), vb + (1 + e) * (va - vb))),
    ("ELASTIC_EXCHANGE", lambda m, va, vb, e: (vb, va)),
    ("EACH_BODY_ALONE", lambda m, va, vb, e: (-e * va, -e * vb)),
    ("VELOCITIES_SCALED", lambda m, va, vb, e: _scaled(m, va, vb, e, 2.0)),
    ("RESTITUTION_ON_TOP", lambda m, va, vb, e: _scaled(m, va, vb, e, 1 + e)),
)

_HEAD_ON = {
    "old": (("OLD_VELOCITY_AFTER", (0,)), ("OLD_VELOCITY_AFTER", (1,))),
    "factor": formulas.FACTORS,
    "give": formulas.GIVES,
    "kick": formulas.TERMS["resolve"][2]["kick"],
    "shares": formulas.TERMS["resolve"][2]["shares"],
    "over": formulas.TERMS["resolve"][2]["over"],
    "reach": (
        ("RADIUS_IGNORED", lambda r: 0.0),
        ("ONE_RADIUS_BETWEEN", lambda r: r),
        ("RADIUS_ADDED_TWICE", lambda r: 4 * r),
    ),
    "count": (
        ("TRUNCATED_STEP_COUNT", int),
        *formulas.each("OFF_BY_ONE_SAMPLE", lambda x: round(x) - 1, lambda x: round(x) + 1),
        ("OFF_BY_ONE_SAMPLE", lambda x: int(x) + 1),
    ),
    "late": (("IMPACT_AT_SAMPLE", True),),
    "rest": (("REST_OF_STEP_LOST", 0.0),),
    "passes": (("PASSES_THROUGH", True),),
    "first": (("INITIAL_STATE_MISSING", False),),
    "overlaps": (("TUNNELS", True),),
    "waits": (
        ("MOMENT_IN_STEP_WRONG", lambda gap, va, vb: max(gap, 0.0) / (abs(va) + abs(vb))),
        ("MOMENT_IN_STEP_WRONG", lambda gap, va, vb: max(gap, 0.0) / max(abs(va), abs(vb))),
        ("MOMENT_IN_STEP_WRONG", lambda gap, va, vb: max(gap, 0.0) / (va - vb) / 2),
    ),
    "leaves": (("TIME_LEFT_WRONG", lambda h, wait: h), ("TIME_LEFT_WRONG", lambda h, wait: wait)),
    "slow": formulas.TERMS["resolve"][2]["slow"],
}


def _drop(
    rebound=lambda e: e,
    floor=lambda r: r,
    fall=0.5,
    pull=1.0,
    count=round,
    late=False,
    rest=1.0,
    slowest=1.0,
    calm=True,
    holds=True,
    first=True,
    launches=True,
    passes=False,
    falls_on=1.0,
    leaves=lambda h, v, speed, up, g: h - (v + speed) / g,
    lands=None,
    depth=lambda z, low: max(z - low, 0.0),
    straight=None,
    arrives=False,
    mirror=None,
    starts=lambda v0: v0,
    rest_of=lambda left, h: (left, left, left),
):
    """``fall``: what stands for 1/2 in g h²/2; ``slowest``: rests below so many g h; ``calm``: it ever rests;

    ``holds``: at rest the floor carries it; ``launches``: what lies on the floor at first may fly;
    ``falls_on``: the share of gravity in what is left of the step after a bounce; ``straight(v, v_next, speed)``:
    at what constant velocity the ball comes to the floor, which says when, and with ``arrives`` how fast it is
    there; ``mirror(e, speed, v_next)``: how far it is put above the floor, as a share of how deep it would be,
    and how fast it leaves.
    """

    def simulate(z0, v0, radius, e, g, t_end, h):
        n, low, down = count(t_end / h), floor(radius), pull * g
        z, v = z0, starts(v0)
        resting = not launches and z <= low
        rows = [(z0, v0)]
        for _ in range(n):
            z_next, v_next = z + v * h - fall * down * h * h, v - down * h
            if resting:
                z_next, v_next = (low, 0.0) if holds else (z_next, v_next)
            elif z_next < low and not passes:
                speed = math.sqrt(max(v**2 + 2 * down * depth(z, low), 0.0))
                up = rebound(e) * (lands(v, v_next) if lands else speed)
                left = leaves(h, v, speed, up, down)
                if straight and (pace := straight(v, v_next, speed)) < 0:
                    left = h - min((z - low) / -pace, h)
                    up = rebound(e) * abs(v - down * (h - left)) if arrives else up
                resting = calm and up <= slowest * g * h
                if mirror:
                    share, v_next = mirror(e, speed, v_next)
                    z_next, resting = low + share * (low - z_next), v_next <= slowest * g * h
                    z_next, v_next = (low, 0.0) if resting else (z_next, v_next)
                elif late:
                    v_next = 0.0 if resting else rebound(e) * abs(v_next)
                elif resting:
                    z_next, v_next = low, 0.0
                else:
                    left *= rest
                    on = falls_on * down
                    moved, pulled, slowed = rest_of(left, h)
                    z_next, v_next = low + up * moved - 0.5 * on * pulled * pulled, up - on * slowed
            z, v = z_next, v_next
            rows.append((z, v))
        rows = np.array(rows if first else rows[1:]).reshape(-1, 2)
        return h * (np.arange(len(rows)) + (not first)), rows[:, 0], rows[:, 1]

    return simulate


_DROP = {
    "rebound": (
        ("RESTITUTION_SQUARED", lambda e: e * e),
        ("RESTITUTION_AS_ENERGY", math.sqrt),
        *formulas.each("RESTITUTION_IGNORED", lambda e: 1.0, lambda e: 0.0),
        *formulas.each("RESTITUTION_DOUBLED", lambda e: 1 + e, lambda e: 2 * e),
        ("RESTITUTION_HALVED", lambda e: e / 2),
        ("REBOUND_COMPLEMENT", lambda e: 1 - e),
    ),
    "floor": (
        ("RADIUS_IGNORED", lambda r: 0.0),
        ("FLOOR_TOO_HIGH", lambda r: 2 * r),
        ("RADII_HALVED", lambda r: r / 2),
    ),
    "fall": (
        *formulas.each("EULER_IN_FLIGHT", 1.0, 0.0),
        *formulas.each("FLIGHT_WRONG", 0.25, -0.5),
    ),
    "pull": (("GRAVITY_WRONG", -1.0), ("GRAVITY_WRONG", 2.0), ("GRAVITY_WRONG", 0.5), ("GRAVITY_WRONG", 0.0)),
    "count": _HEAD_ON["count"],
    "late": (("IMPACT_AT_SAMPLE", True),),
    "rest": (("REST_OF_STEP_LOST", 0.0),),
    "slowest": (("RESTS_TOO_EARLY", 10.0), ("RESTS_TOO_EARLY", 5.0), ("RESTING_JITTER", 0.1)),
    "calm": (("RESTING_JITTER", False),),
    "holds": (("SINKS_THROUGH_FLOOR", False),),
    "first": (("INITIAL_STATE_MISSING", False),),
    "launches": (("LAUNCH_IGNORED", False),),
    "falls_on": (("REST_OF_STEP_WITHOUT_GRAVITY", 0.0),),
    "leaves": (
        ("TIME_LEFT_WRONG", lambda h, v, speed, up, g: h - (v + up) / g),
        ("TIME_LEFT_WRONG", lambda h, v, speed, up, g: (v + speed) / g),
        ("TIME_LEFT_WRONG", lambda h, v, speed, up, g: h - speed / g),
        ("TIME_LEFT_WRONG", lambda h, v, speed, up, g: h),
    ),
    "lands": (
        ("SPEED_AT_STEP_END", lambda v, v_next: abs(v_next)),
        ("SPEED_AT_STEP_START", lambda v, v_next: abs(v)),
    ),
    "depth": (
        ("FALLS_TO_ZERO", lambda z, low: z),
        ("FALL_WITHOUT_TWO", lambda z, low: max(z - low, 0.0) / 2),
        ("FALL_WITHOUT_TWO", lambda z, low: max(z - low, 0.0) / 4),
    ),
    "passes": (("FALLS_THROUGH_FLOOR", True),),
    "straight": (
        ("CONTACT_ON_A_LINE", lambda v, v_next, speed: (v + v_next) / 2),
        *formulas.each("CONTACT_ON_A_LINE", lambda v, v_next, speed: v, lambda v, v_next, speed: v_next),
        ("CONTACT_ON_A_LINE", lambda v, v_next, speed: -speed),
    ),
    "mirror": (
        ("PATH_MIRRORED", lambda e, speed, v_next: (1.0, -e * v_next)),
        ("PATH_MIRRORED", lambda e, speed, v_next: (e, -e * v_next)),
        ("PATH_MIRRORED", lambda e, speed, v_next: (1.0, e * speed)),
        ("PATH_MIRRORED", lambda e, speed, v_next: (e, e * speed)),
    ),
}


def _hops(
    fall=lambda v, z, low, g: math.sqrt(max(v * v + 2 * g * (z - low), 0.0)),
    wait=lambda v, speed, g: (v + speed) / g,
    flies=lambda z, v, s, g: (z + v * s - g * s * s / 2, v - g * s),
    rebound=lambda e: e,
    left=lambda left, wait: left - wait,
    on=None,
    floor=lambda r: r,
):
    """Contact after contact: how fast the ball is there and when, whether that is in the step, how it goes on.

    ``on``: the flight in what is left of the step, if it is another than ``flies``.
    """

    def simulate(z0, v0, radius, e, g, t_end, h):
        (z, v), low, rows = (z0, v0), floor(radius), [(z0, v0)]
        rests = z0 <= radius and abs(v0) <= g * h
        for _ in range(round(t_end / h)):
            rest, flight = h, flies
            for _ in range(100):  # of some wrong programs the loop has no end
                speed = fall(v, z, low, g)
                moment = wait(v, speed, g)
                if rests or moment > rest:
                    break
                rest, flight = left(rest, moment), on or flies
                z, v = low, rebound(e) * speed
                rests = v <= g * h
            z, v = (radius, 0.0) if rests else flight(z, v, rest, g)
            rows.append((z, v))
        z, v = np.array(rows).T
        return h * np.arange(len(rows)), z, v

    return simulate


_HOPS = {
    "fall": (
        ("FALLS_TO_ZERO", lambda v, z, low, g: math.sqrt(max(v * v + 2 * g * z, 0.0))),
        ("FALL_WITHOUT_TWO", lambda v, z, low, g: math.sqrt(max(v * v + g * (z - low), 0.0))),
        ("GRAVITY_TYPED_IN", lambda v, z, low, g: math.sqrt(max(v * v + 19.62 * (z - low), 0.0))),
    ),
    "wait": (
        ("TIME_TO_FLOOR_SIGN", lambda v, speed, g: (speed - v) / g),
        ("TIME_TO_FLOOR_SIGN", lambda v, speed, g: (v - speed) / g),
        ("GRAVITY_TYPED_IN", lambda v, speed, g: (v + speed) / 9.81),
    ),
    "flies": (
        ("GRAVITY_TYPED_IN", lambda z, v, s, g: (z + v * s - g * s * s / 2, v - 9.81 * s)),
        ("GRAVITY_TYPED_IN", lambda z, v, s, g: (z + v * s - 9.81 * s * s / 2, v - g * s)),
        ("FLIGHT_WITH_NEW_VELOCITY", lambda z, v, s, g: (z + (v - g * s) * s - g * s * s / 2, v - g * s)),
        ("EULER_IN_FLIGHT", lambda z, v, s, g: (z + (v - g * s) * s, v - g * s)),
        ("EULER_IN_FLIGHT", lambda z, v, s, g: (z + v * s, v - g * s)),
    ),
    "on": (
        ("REST_OF_STEP_WITHOUT_GRAVITY", lambda z, v, s, g: (z + v * s, v)),
        ("REST_OF_STEP_WITHOUT_GRAVITY", lambda z, v, s, g: (z + v * s, v - g * s)),
        ("REST_OF_STEP_WITHOUT_GRAVITY", lambda z, v, s, g: (z + v * s - g * s * s / 2, v)),
    ),
    "rebound": _DROP["rebound"],
    "floor": _DROP["floor"],
    "left": (("TIME_LEFT_WRONG", lambda left, wait: wait), ("TIME_LEFT_WRONG", lambda left, wait: left)),
}
