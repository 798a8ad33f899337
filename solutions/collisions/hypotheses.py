"""Wrong programs for the tasks of ``collisions``, as functions: what a diagnosis is compared with.

Each is the right program with one of its terms in another form, or with two. They are made from the terms in
``formulas.py`` and from those of the two simulations below.
"""

from __future__ import annotations

import math

import numpy as np

from course.scoring import kit

formulas = kit.sibling(__file__, "formulas")

#: What else is true of a program with a mistake, by its code.
ALSO = {
    "SPEED_UNSIGNED": ("IMPULSE_ON_SEPARATING",),
    "GRAVITY_WRONG": ("OTHER_GRAVITY",),
    "RESTING_JITTER": ("SINKS_THROUGH_FLOOR",),
    "REBOUND_COMPLEMENT": ("RESTS_TOO_EARLY",),
}


def hypotheses():
    """Task, codes of what is wrong, and function of each, those with one mistake first."""
    families = {task: (family, base, terms) for task, (family, base, terms) in formulas.TERMS.items()}
    families["simulate_head_on"] = _head_on, {}, _HEAD_ON
    families["simulate_drop"] = _drop, {}, _DROP
    for task, (family, base, terms) in families.items():
        for codes, function in formulas.OTHERS.get(task, ()):
            yield task, codes, function
        for term, forms in terms.items():
            for code, form in forms:
                yield task, (code,), family(**base | {term: form})
        yield from _pairs(task, family, base, terms)


def _pairs(task, family, base, terms):
    """Two terms wrong at once, each in the first form of its code."""
    firsts = {term: dict(reversed(forms)).items() for term, forms in terms.items()}
    names = list(terms)
    for number, one in enumerate(names):
        for other in names[number + 1 :]:
            for code, form in firsts[one]:
                for second, another in firsts[other]:
                    if code != second:
                        yield task, (code, second), family(**base | {one: form, other: another})


# -- two balls head on ------------------------------------------------------------------------------------


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
    waits=lambda gap, va, vb: max(gap, 0.0) / (va - vb),
    leaves=lambda h, wait: h - wait,
    old=(),
):
    """``late``: the impact comes at the sample after; ``rest``: what is flown of the rest of the step;

    ``old``: which balls fly it with their old velocities; ``overlaps``: it acts only if the balls overlap at
    the end of the step; ``first``: keeps row 0.
    """

    def collide(m, va, vb, e):
        if slow is not None and va - vb < slow:
            e = 0.0
        j = factor(e) * (va - vb) / give(*m)
        return va + shares[0] * kick(j, m[0], m[1]), vb + shares[1] * kick(j, m[1], m[0])

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
                xa, xb = xa + va * wait, xb + vb * wait
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


_HEAD_ON = {
    "old": (("OLD_VELOCITY_AFTER", (0,)), ("OLD_VELOCITY_AFTER", (1,))),
    "factor": formulas.FACTORS,
    "give": formulas.GIVES,
    "kick": formulas.TERMS["resolve"][2]["kick"],
    "shares": formulas.TERMS["resolve"][2]["shares"],
    "reach": (
        ("RADIUS_IGNORED", lambda r: 0.0),
        ("ONE_RADIUS_ONLY", lambda r: r),
        ("RADIUS_ADDED_TWICE", lambda r: 4 * r),
    ),
    "count": (
        ("TRUNCATED_STEP_COUNT", int),
        ("OFF_BY_ONE_SAMPLE", lambda x: round(x) - 1),
        ("OFF_BY_ONE_SAMPLE", lambda x: round(x) + 1),
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

# -- a ball that bounces ----------------------------------------------------------------------------------


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
):
    """``fall``: what stands for 1/2 in g h²/2; ``slowest``: rests below so many g h; ``calm``: it ever rests;

    ``holds``: at rest the floor carries it; ``launches``: what lies on the floor at first may fly;
    ``falls_on``: the share of gravity in what is left of the step after a bounce.
    """

    def simulate(z0, v0, radius, e, g, t_end, h):
        n, low, down = count(t_end / h), floor(radius), pull * g
        z, v = z0, v0
        resting = not launches and z <= low
        rows = [(z, v)]
        for _ in range(n):
            z_next, v_next = z + v * h - fall * down * h * h, v - down * h
            if resting:
                z_next, v_next = (low, 0.0) if holds else (z_next, v_next)
            elif z_next < low and not passes:
                speed = math.sqrt(max(v**2 + 2 * down * depth(z, low), 0.0))
                up = rebound(e) * (lands(v, v_next) if lands else speed)
                left = leaves(h, v, speed, up, down)
                resting = calm and up <= slowest * g * h
                if late:
                    v_next = 0.0 if resting else rebound(e) * abs(v_next)
                elif resting:
                    z_next, v_next = low, 0.0
                else:
                    left *= rest
                    on = falls_on * down
                    z_next, v_next = low + up * left - 0.5 * on * left * left, up - on * left
            z, v = z_next, v_next
            rows.append((z, v))
        rows = np.array(rows if first else rows[1:]).reshape(-1, 2)
        return h * (np.arange(len(rows)) + (not first)), rows[:, 0], rows[:, 1]

    return simulate


_DROP = {
    "rebound": (
        ("RESTITUTION_SQUARED", lambda e: e * e),
        ("RESTITUTION_AS_ENERGY", math.sqrt),
        ("RESTITUTION_IGNORED", lambda e: 1.0),
        ("RESTITUTION_IGNORED", lambda e: 0.0),
        ("RESTITUTION_DOUBLED", lambda e: 1 + e),
        ("RESTITUTION_DOUBLED", lambda e: 2 * e),
        ("RESTITUTION_HALVED", lambda e: e / 2),
        ("REBOUND_COMPLEMENT", lambda e: 1 - e),
    ),
    "floor": (
        ("RADIUS_IGNORED", lambda r: 0.0),
        ("FLOOR_TOO_HIGH", lambda r: 2 * r),
        ("RADII_HALVED", lambda r: r / 2),
    ),
    "fall": (
        ("EULER_IN_FLIGHT", 1.0),
        ("EULER_IN_FLIGHT", 0.0),
        ("FLIGHT_WRONG", 0.25),
        ("FLIGHT_WRONG", -0.5),
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
}
