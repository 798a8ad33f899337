"""Mistakes in `engine-comparison`: words beside the programs that they are true of."""

from __future__ import annotations

import itertools
import math

import numpy as np

from course.authoring.mistakes import Mistakes
from course.scoring import kit

mistakes = Mistakes()

mistakes(
    "ORDER_AGAINST_UNDAMPED",
    "The order is right for engines without damping and too low for the others, as with a comparison against the exact spring.",
    "An engine with damping does not converge to the exact spring. Compare the engine with itself: the same time with n, 2n and 4n steps.",
    kind="consequence",
).body(
    "characterise",
    """
        def error(n):
            q, v = engine.run("spring", [1.0], [0.7 * omega], 1.3 / omega / n, n, [0.0])
            exact = np.array([math.cos(1.3) + 0.7 * math.sin(1.3), 0.7 * math.cos(1.3) - math.sin(1.3)])
            return np.linalg.norm(np.array([q[-1][0], v[-1][0] / omega]) - exact)

        return round(math.log2(error(32) / error(64)))
    """,
    of="_order",
)
mistakes(
    "ORDER_LOCAL",
    "The orders are one too high. The error of a single step gives such orders.",
    "Run for one fixed time, so that half the step means twice as many steps. If your code already does that, add nothing to the slope.",
).body(
    "characterise",
    """
        def after(h, n):
            q, v = engine.run("spring", [1.0], [0.7 * omega], h, n, [0.0])
            return np.array([q[-1][0], v[-1][0] / omega])

        def gap(z):
            return np.linalg.norm(after(z / omega, 1) - after(z / omega / 2, 2))

        return round(math.log2(gap(0.1) / gap(0.05)))
    """,
    of="_order",
)
mistakes(
    "ORDER_AT_TURNING_POINT",
    "Some orders are one or two too high. Perhaps the runs start at rest or in the middle, or end after a whole half-period: there the leading error vanishes.",
    "Start with both a position and a velocity, and end at an ordinary moment.",
    kind="consequence",
).body(
    "characterise",
    """
        def end(n):
            q, _ = engine.run("spring", [1.0], [0.0], math.pi / omega / n, n, [0.0])
            return q[-1][0]

        return round(math.log2(abs(end(64) - end(128)) / abs(end(128) - end(256))))
    """,
    of="_order",
)
mistakes(
    "ORDER_IN_ROUNDING",
    "Only accurate engines get a wrong order. Their runs differ by little more than rounding.",
    "Take larger steps, such as a sixteenth to a quarter of 1/omega, and round the slope.",
    kind="consequence",
).body(
    "characterise",
    """
        def end(n):
            q, v = engine.run("spring", [1.0], [0.7 * omega], 0.05 / omega / n, n, [0.0])
            return np.array([q[-1][0], v[-1][0] / omega])

        coarse, middle, fine = end(400), end(800), end(1600)
        gap = max(np.linalg.norm(middle - fine), 1e-16)
        return min(round(math.log2(max(np.linalg.norm(coarse - middle), 1e-16) / gap)), 3)
    """,
    of="_order",
)
mistakes(
    "ORDER_NOT_WHOLE",
    "A measured slope seldom is.",
    "Round it: round(math.log2(ratio)).",
    kind="fact",
).edit("characterise", {"return round(": "return ("}, of="_order")
mistakes(
    "SYMPLECTIC_STEP_TOO_SMALL",
    "Engines that lose area pass the test: what they lose in the step that is looked at lies within what the test allows.",
    "Take one step with h = 0.5/omega, and compare |det - 1| with 1e-6: a kept energy is not a kept area.",
    kind="consequence",
).around("characterise", "return _right(engine, omega, 0.05 if z == 0.5 else z)", of="_spring_step")
mistakes(
    "STABLE_TAKEN_FOR_SYMPLECTIC",
    "Engines that lose area pass the test.",
    "Take the states after one step of h = 0.5/omega as columns, and test abs(det - 1) < 1e-6: below one, too, area is lost.",
    kind="consequence",
).around(
    "characterise",
    """
        omega = engine.info()["omega"]
        radius = max(abs(np.linalg.eigvals(_spring_step(engine, omega, 0.5))))
        return {**_right(engine), "symplectic": bool(radius <= 1 + 1e-6)}
    """,
)
mistakes(
    "SYMPLECTIC_NEVER",
    "No engine passes the test here, not even one that conserves area.",
    "Build the matrix of one step on (q, v/omega): two runs with n = 1, from (1, 0) and (0, omega), and both velocities divided by omega. Then test abs(det - 1) < 1e-6, where [[a, b], [c, d]] has det = a d - b c.",
    kind="consequence",
).around(
    "characterise",
    """
        omega = engine.info()["omega"]
        q, v = engine.run("spring", [1.0], [0.4 * omega], 0.5 / omega, 1, [0.0])
        energy = [x[0] ** 2 + (y[0] / omega) ** 2 for x, y in zip(q, v)]
        return {**_right(engine), "symplectic": bool(abs(energy[1] / energy[0] - 1) < 1e-6)}
    """,
)
mistakes(
    "DAMPING_AT_DT",
    "The rate still contains the error of large steps.",
    "Use a much smaller step, such as dt / 1000.",
).edit("characterise", {"dt / 1000, 100": "dt, 20"}, of="_linear_damping")
mistakes(
    "DAMPING_PER_STEP",
    "The result is the loss of ln|v| per step or per run, not per second.",
    "Divide the change of ln|v| by the time between the two samples, n times h.",
).edit("characterise", {"1000, 100": "1000, 1000", " / (n * h)": ""}, of="_linear_damping")
mistakes(
    "DAMPING_OF_ENERGY",
    "The rate is twice as large as it should be.",
    "Energy decays twice as fast as speed. Take ln(v0/v), and divide it by all the time between these two speeds.",
).edit("characterise", {"v[-1][0])": "v[-1][0] ** 2)"}, of="_linear_damping")
mistakes(
    "DAMPING_OF_ENVELOPE",
    "The rate is about half of what it should be.",
    "The mean speed of a run, and the amplitude of a spring, fall at half the rate. Take a free body, its speeds at the start and at the end, and the time between.",
).body(
    "characterise",
    """
        omega = engine.info()["omega"]
        # ln det of the step's matrix is the loss of area; its half is the loss of amplitude.
        z = omega * dt / 1000
        return -math.log(np.linalg.det(_spring_step(engine, omega, z))) / 2 / (dt / 1000)
    """,
    of="_linear_damping",
)
mistakes(
    "LIMIT_FROM_ABOVE",
    "An engine that becomes unstable, then stable again, gets a limit beyond the first one. Does the search come from above, jump over an unstable range, or look at one eigenvalue alone?",
    "Increase the step from 0.05/omega in increments of 0.5/omega, stop where the largest modulus first exceeds 1 + 1e-8, and bisect between that step and the one before it.",
    kind="consequence",
).body(
    "characterise",
    """
        def stable(z):
            return max(abs(np.linalg.eigvals(_spring_step(engine, omega, z)))) <= 1 + 1e-8

        if not stable(0.05):
            return 0.0
        high = 10.0
        if stable(high):
            return math.inf
        while not stable(high - 0.1):
            high -= 0.1
        return _bisect(stable, high - 0.1, high, 0.01)
    """,
    of="_max_stable_z",
).edit(
    "characterise",
    {
        "stable(low + 0.5)": "stable(low + 1.99)",
        "low += 0.5": "low += 1.99",
        "low, low + 0.5": "low, low + 1.99",
    },
    of="_max_stable_z",
).edit(
    "characterise",
    {
        "stable(low + 0.5)": "stable(low + 2.5)",
        "low += 0.5": "low += 2.5",
        "low, low + 0.5, 0.004": "low, low + 2.5, 0.002",
    },
    of="_max_stable_z",
)
mistakes(
    "LIMIT_ASSUMED",
    "The result times omega is the same for different engines.",
    "For each h, build the matrix of one step from two runs and look at its eigenvalues.",
).body("characterise", "return 2.0", of="_max_stable_z")
mistakes(
    "RETURNS_Z",
    "The result is as large as the step times omega.",
    "Divide by omega: the answer is a time in seconds.",
).around("characterise", "return _right(engine, omega) * omega", of="_max_stable_z")
mistakes(
    "NO_ZERO",
    "An engine that is unstable even at the smallest step gets a positive limit.",
    "Return 0.0 if an eigenvalue of the step h = 0.05/omega has a modulus above 1 + 1e-8; a run of a few hundred steps does not tell.",
    kind="consequence",
).body(
    "characterise",
    """
        def stable(z):
            q, v = engine.run("spring", [1.0], [0.3 * omega], z / omega, 2000, [0.0])
            return max(abs(x[0]) for x in q) < 3

        low = 0.05
        while low < 10 and stable(low + 0.25):
            low += 0.25
        return math.inf if low >= 10 else _bisect(stable, low, low + 0.25, 0.004 * low)
    """,
    of="_max_stable_z",
)
mistakes(
    "NO_INFINITY",
    "An engine that is never unstable gets a finite number.",
    "Return math.inf if no step in the README's range is unstable.",
    kind="consequence",
).around("characterise", "return min(_right(engine, omega), 10.0)", of="_max_stable_z")
mistakes(
    "ANISOTROPY_INVERTED",
    "The result is as large as one over the right ratio.",
    "The force along the diagonal is the numerator: F(45 degrees) / F(0 degrees).",
).around("characterise", "return 1 / _right(engine, info)", of="_anisotropy")
mistakes(
    "DIAGONAL_COMPONENT",
    "The ratio is too small by the square root of two, as if one component of the diagonal force were the force.",
    "Push with (F cos 45°, F sin 45°, 0) and report F. A push of (F, F, 0) is the square root of two times as large as F.",
).around("characterise", "return _right(engine, info) / math.sqrt(2)", of="_anisotropy")
mistakes(
    "ANISOTROPY_ASSUMED",
    "Engines whose ratios differ all get the same one.",
    "Let the body settle first. From where it lies, bisect the least force that makes it faster than 0.01 m/s: along x, and along the diagonal.",
).body("characterise", "return 1.0", of="_anisotropy")
mistakes(
    "DIAGONAL_NOT_PUSHED",
    "Every push went along x or along y, and none along the diagonal.",
    "F(45°) is the least force along (1, 1, 0)/√2.",
).edit(
    "characterise",
    {'info["dt"], n, push)': 'info["dt"], n, [0 if angle else force, force if angle else 0, 0])'},
    of="_anisotropy",
)
mistakes(
    "CREEP_TAKEN_FOR_SLIP",
    "Only engines whose bodies creep get a wrong ratio. Perhaps creeping is taken for sliding.",
    "A body slides when it becomes faster than 0.01 m/s, not when it moves at all.",
    kind="consequence",
).edit("characterise", {") <= 0.01": ") <= 1e-6", ", 0.001 *": ", 1e-7 *"}, of="_anisotropy")
mistakes(
    "NOT_SETTLED",
    "Only engines with soft contact get a wrong ratio. Perhaps the body is pushed while it is still sinking in.",
    "Let the body come to rest first, and start each push from where it lies.",
    kind="consequence",
).edit(
    "characterise", {"_settled(engine, info), round": '[0.0, 0.0, info["radius"]], round'}, of="_anisotropy"
)
mistakes(
    "PENETRATION_SIGN",
    "A body that sinks in gets a depth of zero or less, or one that hovers gets a positive depth.",
    "The depth is max(0, radius - z): the centre of a body that sinks in is lower than its radius.",
).around(
    "characterise",
    """
        info = engine.info()
        return {**_right(engine), "rest_penetration": max(0.0, _settled(engine, info)[2] - info["radius"])}
    """,
)
mistakes(
    "PENETRATION_NEGATIVE",
    "An engine that keeps bodies at a distance gets a negative depth.",
    "The report asks for max(0, radius - z).",
).around(
    "characterise",
    """
        info = engine.info()
        return {**_right(engine), "rest_penetration": info["radius"] - _settled(engine, info)[2]}
    """,
)
mistakes(
    "PENETRATION_TOO_EARLY",
    "Only engines with soft contact get a wrong depth. It is measured while the body still moves.",
    "Wait five seconds, and take the last sample.",
    kind="consequence",
).around(
    "characterise",
    """
        info = engine.info()
        q, _ = engine.run(
            "floor", [0, 0, info["radius"]], [0, 0, 0], info["dt"], round(5 / info["dt"]), [0, 0, 0]
        )
        deepest = max(0.0, info["radius"] - min(z for _, _, z in q))
        return {**_right(engine), "rest_penetration": deepest}
    """,
)
mistakes(
    "RESTITUTION_SIGN",
    "For at least one engine the ratio is negative.",
    "The velocity changes its sign at the wall, and the report asks for the ratio of the speeds. Does the body reach the wall?",
).edit("characterise", {"return -v": "return v"}, of="_slow_hit")
mistakes(
    "RESTITUTION_SQUARED",
    "The ratio is squared, or its square root is taken.",
    "Divide the speed after the hit by the speed before it, without a square.",
).edit("characterise", {"-v[hit][0] / v[hit - 1][0]": "(v[hit][0] / v[hit - 1][0]) ** 2"}, of="_slow_hit")
mistakes(
    "RESTITUTION_WITH_DRAG",
    "The ratio is too low for engines with damping: speed that is lost before the hit, or after it, counts as lost in the hit.",
    "Start at 2 m/s close to the wall, and compare the last sample before the hit with the first one after it.",
    kind="consequence",
).around(
    "characterise",
    """
        dt = info["dt"]
        speed = 2.0
        q, v = engine.run("wall", [-1.0], [speed], dt, round(0.8 / dt), [0])
        return -v[-1][0] / speed, _right(engine, info)[1]
    """,
    of="_slow_hit",
)
mistakes(
    "RESTITUTION_OTHER_SPEED",
    "Engines in which slow bodies do not bounce get zero. Perhaps the body meets the wall at less than 2 m/s.",
    "Let the body hit the wall at 2 m/s, because the coefficient may depend on the speed.",
    kind="consequence",
).around(
    "characterise",
    """
        start = -(info["radius"] + info["wall_thickness"] / 2) - 3.5 * info["dt"]
        q, v = engine.run("wall", [start], [1.0], info["dt"], 10, [0])
        hit = next(i for i in range(11) if v[i][0] <= 0)
        return -v[hit][0] / v[hit - 1][0], _right(engine, info)[1]
    """,
    of="_slow_hit",
)
mistakes(
    "TUNNEL_ONE_START",
    "The speed is too high, and most speeds were tried from one start only.",
    "Try many starts, spread evenly over [-1 - v dt, -1], in runs of 2 m + v dt. A speed is safe only if none gets through.",
    kind="consequence",
).body(
    "characterise",
    """
        dt = info["dt"]

        def stopped(speed):
            q, _ = engine.run("wall", [-1.0], [speed], dt, math.ceil(4 / (speed * dt)) + 2, [0])
            return q[-1][0] < 0

        speeds = np.geomspace(2.0, 199.0, 120)
        safe = [speed for speed in speeds if stopped(speed)]
        return math.inf if len(safe) == len(speeds) else float(next(s for s in speeds if not stopped(s)))
    """,
    of="_tunnelling_speed",
)
mistakes(
    "TUNNEL_FEW_STARTS",
    "The speed is too high. Perhaps a start between those that were tried gets through.",
    "Try more of them: with k starts, the result is uncertain by one part in k.",
    kind="consequence",
).body(
    "characterise",
    """
        dt = info["dt"]

        def stopped(speed):
            n = math.ceil(4 / (speed * dt)) + 3
            starts = [-1 - speed * dt * k / 4 for k in range(4)]
            return all(engine.run("wall", [s], [speed], dt, n, [0])[0][-1][0] < 0 for s in starts)

        if stopped(199.0):
            return math.inf
        return _bisect(stopped, 2.0, 199.0, 0.1)
    """,
    of="_tunnelling_speed",
)
mistakes(
    "TUNNEL_BY_GEOMETRY",
    "The results are a formula of the body's size and dt.",
    "Engines look for contact in different ways: shoot bodies at the wall.",
).body(
    "characterise",
    'return (2 * info["radius"] + info["wall_thickness"]) / info["dt"]',
    of="_tunnelling_speed",
)
mistakes(
    "TUNNEL_NO_INFINITY",
    "An engine that stops everything gets a finite number.",
    "Return math.inf if nothing gets through in the README's range of speeds.",
    kind="consequence",
).around("characterise", "return min(_right(engine, info), 200.0)", of="_tunnelling_speed")
mistakes(
    "DETERMINISM_ONE_RUN",
    "Every engine is called deterministic, but no run was made twice in a row.",
    "Run the same experiment twice, and compare every number of both with np.array_equal.",
    kind="consequence",
).program(
    "characterise",
    """
        _REST = {}


        def _deterministic(engine, dt):
            _REST.clear()
            return True


        _first_settled = _settled


        def _settled(engine, info):
            if "rest" not in _REST:
                _REST["rest"] = _first_settled(engine, info)
            return _REST["rest"]


        _first_hit = _slow_hit


        def _slow_hit(engine, info):
            if "hit" not in _REST:
                _REST["hit"] = _first_hit(engine, info)
            return _REST["hit"]
    """,
)
mistakes(
    "DETERMINISM_TOLERANCE",
    "Engines whose runs differ slightly are called deterministic.",
    "Compare the numbers as they are, with np.array_equal: bit for bit leaves no room for a tolerance or for rounding.",
).edit("characterise", {"array_equal": "allclose"}, of="_deterministic")
mistakes(
    "DETERMINISM_OTHER_RUN",
    "No engine is called deterministic, not even one whose runs repeat exactly.",
    "Compare two runs with the same arguments, by their numbers: np.array_equal.",
).body(
    "characterise",
    """
        first = engine.run("spring", [1.0], [0.5], dt, 50, [0.0])
        second = engine.run("spring", [1.0], [0.5], dt / 2, 100, [0.0])
        return bool(np.array_equal(first[0][-1], second[0][-1]))
    """,
    of="_deterministic",
)
mistakes("WRONG_KEYS").around("characterise", 'return {**_right(engine), "name": "unknown"}')
mistakes(
    "MEASURED_AS_NONE",
    "",
    "If you measure it already, perhaps an exception that you catch became None, `x or None` turned a 0 into None, or what you wait for never came: a body that stops dead has v = 0.",
    kind="fact",
).around("characterise", 'return {**_right(engine), "friction_anisotropy": None}')
mistakes("ENGINE_MISUSED").body(
    "characterise",
    """
        _, v = engine.run("free", [0.0], [1.0], dt / 1e7, 1_000_000, [0.0])
        return -math.log(v[-1][0]) / (0.1 * dt)
    """,
    of="_linear_damping",
)
mistakes(
    "IGNORES_MISSING",
    "Your code accepts an engine whose report lacks a required key, or has None there.",
    "What was not measured meets nothing: neither a value of None nor a key that is not there.",
).edit("choose_engine", {"is not None and": "is None or"})
mistakes(
    "COST_BEFORE_REQUIREMENTS",
    "Your code takes the cheapest of all engines and only then looks at the requirements.",
    "First keep the engines that meet every requirement, then take the cheapest of those.",
).around(
    "choose_engine",
    """
        cheapest = min(reports, key=lambda name: reports[name]["cost"])
        return _right({cheapest: reports[cheapest]}, requirements)
    """,
)
mistakes(
    "COST_REVERSED",
    "Of the engines that fit, your code picks the most expensive one.",
    "Take the one with the lowest cost.",
).edit("choose_engine", {'reports[name]["cost"]': '-reports[name]["cost"]'})
mistakes(
    "COST_IGNORED",
    "Of the engines that fit, your code picks one that is not the cheapest.",
    "Take the one with the lowest cost.",
).edit("choose_engine", {'reports[name]["cost"]': "0.0"}).around(
    "choose_engine",
    """
        fitting = [name for name in reports if _right({name: reports[name]}, requirements)]
        return fitting[-1] if fitting else None
    """,
)
mistakes(
    "ANY_INSTEAD_OF_ALL",
    "Your code picks an engine that does not meet all of the requirements.",
    "Every requirement must be met, not just one of them.",
).edit(
    "choose_engine",
    {
        "return all(": "return sum(",
        "(name for name, report in reports.items() if fits(report))": "reports",
        'reports[name]["cost"],\n        default=None,': '(-fits(reports[name]), reports[name]["cost"]),',
    },
)
mistakes(
    "ALL_MUST_FIT",
    "Your code returns None as soon as one of the engines does not meet a requirement.",
    "Leave that engine out, and go on with the next one.",
)
mistakes(
    "STOPS_AT_MISFIT",
    "No engine that comes after one that does not fit is chosen.",
    "Go on with the next engine: `break` and `return` end the loop, `continue` does not. Reset what you keep about one engine before you look at the next.",
).body(
    "choose_engine",
    """
        best = None
        for name, report in reports.items():
            values = [(report.get(r["key"]), r) for r in requirements]
            if not all(value is not None and _OPERATORS[r["op"]](value, r["value"]) for value, r in values):
                break
            if best is None or report["cost"] < reports[best]["cost"]:
                best = name
        return best
    """,
)
mistakes(
    "STRICT_COMPARISON",
    "Your code rejects an engine that meets a limit exactly.",
    '"<=" and ">=" include equality.',
).program("choose_engine", '_OPERATORS = {"<=": operator.lt, ">=": operator.gt, "==": operator.eq}')
mistakes(
    "OPERATOR_CONFUSED",
    "Your code reads an operator as another one.",
    '"<=" means that the report\'s value is at most the required one, ">=" at least, and "==" equal.',
).program("choose_engine", '_OPERATORS = {"<=": operator.ge, ">=": operator.le, "==": operator.eq}')
mistakes(
    "DEPENDS_ON_NAMES",
    "With the same reports under other names, your code picks another engine.",
    "Use only the reports, and compare the costs as they are.",
    kind="consequence",
).around(
    "choose_engine",
    """
        for name in sorted(reports):
            if name.startswith(("mujoco", "ode")) and _right({name: reports[name]}, requirements):
                return name
        return _right(reports, requirements)
    """,
).program(
    "choose_engine",
    """
        _KNOWN = ("anvil", "balsa", "cork", "ode", "bullet", "physx", "mujoco")
        _cheapest = choose_engine


        def choose_engine(reports, requirements):
            known = {name: report for name, report in reports.items() if name.split(",")[0] in _KNOWN}
            return _cheapest(known, requirements)
    """,
).around(
    "choose_engine", "return min((n for n in reports if _right({n: reports[n]}, requirements)), default=None)"
)
mistakes(
    "MUTATES_INPUT",
    "The reports or the requirements were changed.",
    "Build new lists and dicts: setdefault, pop and sort change the given ones.",
    kind="fact",
).around(
    "choose_engine",
    """
        for name in list(reports):
            if _right({name: reports[name]}, requirements) is None:
                del reports[name]
        return min(reports, key=lambda name: reports[name]["cost"], default=None)
    """,
).around(
    "choose_engine",
    """
        left = dict(reports)
        while requirements:
            need = [requirements.pop()]
            left = {name: report for name, report in left.items() if _right({name: report}, need)}
        return _right(left, [])
    """,
).around(
    "choose_engine",
    """
        for report in reports.values():
            for requirement in requirements:
                report.setdefault(requirement["key"], None)
        return _right(reports, requirements)
    """,
)
mistakes(
    "NOTHING_FITS",
    "An engine is returned where None belongs.",
    "A value that nearly meets a requirement does not meet it. Return None if no engine meets every requirement, or if there are no reports.",
    kind="consequence",
).around("choose_engine", 'return _right(reports, requirements) or ""')
mistakes(
    "STALE_LICENCE",
    "This engine is open source today; what is given looks like an older licence.",
    "Read the licence file in today's repository.",
    kind="fact",
).program(
    "engine_facts",
    '_FACTS["mujoco"]["licence"] = ("Proprietary", "https://www.roboti.us/license.html")',
)
mistakes(
    "NOT_SPDX",
    "A licence is not written as its SPDX identifier, or as two joined by OR.",
    "Find its identifier in the SPDX list (spdx.org/licenses). If there is a choice of two, give either, or join them with OR.",
    kind="fact",
).program("engine_facts", '_FACTS["physx"]["licence"] = ("BSD", "https://github.com/NVIDIA-Omniverse/PhysX")')
mistakes(
    "DATE_BEFORE_FACT",
    "The date of a fact is earlier than the day on which it became true.",
    "as_of is the day on which you checked that the fact was true.",
    kind="fact",
).around("engine_facts", 'return [{**entry, "as_of": "2012-10-07"} for entry in _right()]')
mistakes(
    "STEP_OF_A_HABIT",
    "A default step is given for an engine that has none: it takes whatever step the caller passes.",
    "Report None for an engine whose step function needs the step as an argument and has no default for it.",
    kind="fact",
).program("engine_facts", '_FACTS["ode"]["default_step_s"] = (0.001, "https://classic.gazebosim.org")')
mistakes(
    "INTEGRATOR_BY_NAME",
    "No engine here uses explicit Euler by default.",
    "Engines use the name Euler for different methods: which half of the state is updated first?",
    kind="fact",
).program(
    "engine_facts",
    '_FACTS["mujoco"]["default_integrator"] = ("explicit_euler", "https://mujoco.readthedocs.io")',
)
mistakes(
    "STEP_IS_THERE",
    "None is given for an engine that has a default step of its own.",
    "Look for a default argument of the function that steps, or for a default in the list of options.",
    kind="fact",
).program(
    "engine_facts",
    '_FACTS["bullet"]["default_step_s"] = (None, "https://github.com/bulletphysics/bullet3")',
)
mistakes(
    "STEP_OF_OTHERS",
    "The number is not a default of this engine. Examples and programs that use an engine often set another step.",
    "Find the default itself: in the signature of the function that steps, or in the list of options.",
    kind="fact",
).program("engine_facts", '_FACTS["mujoco"]["default_step_s"] = (0.01, "https://mujoco.readthedocs.io")')
mistakes(
    "LANGUAGE_OF_INTERFACE",
    "The engine can be called from the language that is given. It is written in another one.",
    "Which language are most of the files of the engine itself in, without its interface and its bindings?",
    kind="fact",
).program("engine_facts", '_FACTS["ode"]["language"] = ("C", "https://ode.org")')
mistakes(
    "GAZEBO_SIM_USES_DART",
    "Today's Gazebo is listed as a user of ODE.",
    "Gazebo Classic used ODE; Gazebo Sim uses DART by default. Say which of the two you mean.",
    kind="fact",
).program("engine_facts", '_FACTS["ode"]["used_by"] = (["Gazebo Sim"], "https://gazebosim.org")')
mistakes(
    "SOURCE_NOT_A_URL",
    "A source has to be the web address of a page about the fact.",
    "Give the address of the page that you read, starting with https:// and without spaces.",
    kind="fact",
).program("engine_facts", '_FACTS["bullet"]["licence"] = ("Zlib", "its README")')
mistakes(
    "NOT_A_DATE",
    "A date is not a day of this century in the form YYYY-MM-DD.",
    "Write the day on which you looked it up, such as 2026-03-14.",
    kind="fact",
).program("engine_facts", '_AS_OF = "11/21/2026"')
mistakes(
    "PAIR_MISSING",
    "At least one engine has no entry for one of the fields.",
    "There are four engines and five fields: twenty entries.",
    kind="fact",
).program("engine_facts", 'del _FACTS["mujoco"]')
mistakes(
    "PAIR_TWICE_AND_MISSING",
    "One entry is there more than once, and at least one other is not there.",
    "Make one entry for each pair of engine and field. If you fill one dict again and again, make a new one for each entry.",
    kind="fact",
).around(
    "engine_facts",
    """
        kept, listed = {}, []
        for fact in _right():
            entry = kept.setdefault(fact["engine"], {})
            entry.update(fact)
            listed.append(entry)
        return listed
    """,
)
mistakes(
    "PAIR_TWICE",
    "At least one engine has more than one entry for the same field.",
    "Keep one entry for each pair of engine and field.",
    kind="fact",
).around("engine_facts", 'return _right() + [{**_right()[0], "source": "https://ode.org"}]')
mistakes(
    "MISSING_RAISES",
    "Your code raises an exception where a report lacks a required key, or has None there.",
    "report.get(key) gives None for a missing key. Test for None first: such an engine does not fit.",
    kind="fact",
).edit("choose_engine", {'report.get(r["key"]) is not None and ': ""})
mistakes(
    "COST_ROUGH",
    "Costs that are close to each other are taken for equal.",
    "Compare the costs as they are, without rounding.",
).edit("choose_engine", {'reports[name]["cost"]': 'round(reports[name]["cost"], -1)'})
mistakes(
    "FIRST_REQUIREMENT_ONLY",
    "Your code checks only one of the requirements.",
    "Does a return inside the loop end it too early, or does each requirement replace the verdict on the one before it?",
).around("choose_engine", "return _right(reports, requirements[:1])")
mistakes(
    "OTHER_LICENCE",
    "A valid identifier is given, but not of a licence of this engine.",
    "Open the licence file in the engine's repository: name and version count. Of two joined by OR, both must be right.",
    kind="fact",
).program("engine_facts", '_FACTS["ode"]["licence"] = ("GPL-3.0-only", "https://github.com/odedevs/ode")')
mistakes(
    "ORDER_WITHOUT_LOG",
    "The result is two to the power of the order.",
    "Take math.log2 of the ratio, and round.",
).edit(
    "characterise",
    {
        "fine = end(16), end(32), end(64)": "again, fine = end(64), end(128), end(128), end(256)",
        "middle - fine": "again - fine",
        "math.log2": "",
    },
    of="_order",
)
mistakes(
    "ORDER_OTHER_LOG",
    "The result is a logarithm to another base than two.",
    "Halving the step divides the difference by two to the power of the order: take math.log2.",
).edit(
    "characterise",
    {
        "fine = end(16), end(32),": "again, fine = end(16), end(32), end(32),",
        "middle - fine": "again - fine",
        "math.log2": "math.log",
    },
    of="_order",
)
mistakes("NOT_A_NUMBER").edit(
    "characterise", {"round(math.log2(np.linalg": "float(np.log2(-np.linalg"}, of="_order"
)
mistakes(
    "DAMPING_NOT_LOG",
    "The result is the fraction of the speed that is lost, in all or per second. That is less than the rate.",
    "The speed falls as exp(-c t): take -ln(v/v0) / t.",
).edit(
    "characterise",
    {
        "h, n = dt / 1000, 100": "n = 1000",
        ", h,": ", 1 / n,",
        "-math.log(v[-1][0]) / (n * h)": "1 - v[-1][0]",
    },
    of="_linear_damping",
)
mistakes(
    "TUNNEL_NEVER_SEEN",
    "For an engine the result is infinite, although bodies get through.",
    "A speed is unsafe if a single start gets through. Try many for each speed up to 200 m/s, in runs of 2 m + v dt, and look at which side the body ends.",
    kind="nan",
).body(
    "characterise",
    """
        dt = info["dt"]

        def stopped(speed):
            starts = [-1 - speed * dt * k / 16 for k in range(16)]
            return all(engine.run("wall", [s], [speed], dt, 1, [0])[0][-1][0] < 0 for s in starts)

        if stopped(50.0):
            return math.inf
        return _bisect(stopped, 2.0, 199.0, 0.1)
    """,
    of="_tunnelling_speed",
).around(
    "characterise",
    """
        speed = _right(engine, info)
        return speed if speed < 100 else math.inf
    """,
    of="_tunnelling_speed",
)
mistakes(
    "EQUALITY_BY_IDENTITY",
    'Some equal numbers do not count as equal where the operator is "==".',
    "Compare with ==, not with `is`.",
).program("choose_engine", '_OPERATORS = {"<=": operator.le, ">=": operator.ge, "==": operator.is_}')
mistakes(
    "COST_CAPPED",
    "Engines that cost very much are passed over.",
    "Start with the first engine that fits, or with math.inf.",
).edit("choose_engine", {"if fits(report)": 'if report["cost"] < 1000 and fits(report)'})
mistakes(
    "EQUALITY_ROUGH",
    "Your code accepts values that are merely close to the required one.",
    "Requirements are exact: compare with the operator itself, without a tolerance.",
).program(
    "choose_engine",
    """
        def nearly(a, b):
            return math.isclose(a, b) if isinstance(a, float) and isinstance(b, float) else a == b


        _OPERATORS = {"<=": operator.le, ">=": operator.ge, "==": nearly}
    """,
).program(
    "choose_engine",
    '_OPERATORS = {"<=": operator.le, ">=": operator.ge, "==": lambda a, b: abs(a - b) < 0.005}',
).edit(
    "choose_engine",
    {
        "_OPERATORS[r": "(_OPERATORS[r",
        'r["value"])': 'r["value"]) or math.isclose(report[r["key"]], r["value"]))',
    },
)
mistakes(
    "EQUALITY_BY_TYPE",
    "Equal values do not count as equal where one is an int or a bool and the other a float.",
    "Compare with == alone: True == 1 and 2 == 2.0.",
).program(
    "choose_engine",
    '_OPERATORS = {"<=": operator.le, ">=": operator.ge, "==": lambda a, b: type(a) is type(b) and a == b}',
)
mistakes(
    "COST_OF_NOTHING",
    "An engine that costs 0 is passed over.",
    "0 is a cost like any other. As a condition it counts as false: test `is None`.",
).body(
    "choose_engine",
    """
        best = None
        for name, report in reports.items():
            values = [(report.get(r["key"]), r) for r in requirements]
            if not all(value is not None and _OPERATORS[r["op"]](value, r["value"]) for value, r in values):
                continue
            if best is None or not reports[best]["cost"] or report["cost"] < reports[best]["cost"]:
                best = name
        return best
    """,
)
mistakes(
    "ONE_FOR_EACH_KEY",
    "Of two requirements about the same key only one is checked.",
    "Go through the list of requirements itself: a dict by key keeps one of each.",
).around("choose_engine", 'return _right(reports, list({r["key"]: r for r in requirements}.values()))')
mistakes(
    "GROWS_WITH_EACH_CALL",
    "Perhaps something that is kept from one call to the next is filled again, or used up.",
    "Make the list inside the function. An iterator at the top of the file can be read only once.",
    kind="fact",
).program(
    "engine_facts",
    """
        _once = engine_facts
        _listed = []


        def engine_facts():
            _listed.extend(_once())
            return list(_listed)
    """,
)
mistakes(
    "ORDER_NOT_THREE",
    "Orders 1, 2 and 4 are right, and a method of third order gets another.",
    "Round the measured slope to the nearest whole number, whatever it is.",
).around(
    "characterise", "return min((1, 2, 4), key=lambda known: abs(known - _right(engine, omega)))", of="_order"
)
mistakes(
    "RESTITUTION_TOO_FAST",
    "Engines whose wall lets no body leave faster than some speed get too small a ratio. Perhaps the body meets it at more than 2 m/s.",
    "Let the body hit the wall at 2 m/s, because the coefficient may depend on the speed.",
    kind="consequence",
).edit("characterise", {"* 2 *": "* 20 *", " [2.0": " [20.0"}, of="_slow_hit")
mistakes(
    "FORCE_UP_OR_DOWN",
    "In at least one run, a force along z acts on the body besides its weight.",
    'The scene "floor" has gravity already. A push lies in the plane: (F cos a, F sin a, 0). If a depth is wrong without that force, too, look at its sign: max(0, radius - z).',
    kind="fact",
).around(
    "characterise",
    """
        info = engine.info()
        weight = [0, 0, -info["mass"] * info["g"]]
        start = [0, 0, info["radius"]]
        q, _ = engine.run("floor", start, [0, 0, 0], info["dt"], round(5 / info["dt"]), weight)
        return {**_right(engine), "rest_penetration": max(0.0, info["radius"] - q[-1][2])}
    """,
)
mistakes(
    "VALUE_ROUNDED",
    "The wrong values are the right ones, rounded to too few decimals.",
    "Report numbers as they are; round only `order`.",
    kind="consequence",
).around(
    "characterise",
    """
        report = _right(engine)
        return {**report, "rest_penetration": round(float(report["rest_penetration"]), 3)}
    """,
)
mistakes(
    "ENTRIES_ALL_ONE",
    "Perhaps one dict is filled again for every entry.",
    "Make a new dict for each entry, inside the loop.",
    kind="fact",
).around(
    "engine_facts",
    """
        entry, listed = {}, []
        for fact in _right():
            entry.update(fact)
            listed.append(entry)
        return listed
    """,
)
mistakes(
    "REPORT_WITHOUT_RUNS",
    "For at least one engine not a single run was made.",
    "Measure the engine that is given, in every call.",
    kind="fact",
).program(
    "characterise",
    """
        _characterise = characterise
        _REPORTS = {}


        def characterise(engine):
            shown = tuple(sorted(engine.info().items()))
            if shown not in _REPORTS:
                _REPORTS[shown] = _characterise(engine)
            return dict(_REPORTS[shown])
    """,
)
mistakes(
    "ANSWERS_VARY",
    "The same question gets another answer when it is asked again, or after another one.",
    "Leave chance out, and keep nothing from one call to the next.",
    kind="fact",
).program(
    "choose_engine",
    """
        _right = choose_engine
        _VERDICTS = {}


        def choose_engine(reports, requirements):
            def fits(name):
                key = name, repr(requirements)
                if key not in _VERDICTS:
                    _VERDICTS[key] = _right({name: reports[name]}, requirements) is not None
                return _VERDICTS[key]

            return min(filter(fits, reports), key=lambda name: reports[name]["cost"], default=None)
    """,
)
mistakes(
    "VALUE_KEPT",
    "An engine gets, to the last digit, the value of another one with the same info().",
    "Measure the engine that is given, in every call: info() does not say what is inside.",
    kind="consequence",
).program(
    "characterise",
    """
        _characterise = characterise
        _RATES = {}


        def characterise(engine):
            report = _characterise(engine)
            rate = _RATES.setdefault(tuple(engine.info().values()), report["linear_damping"])
            return {**report, "linear_damping": rate}
    """,
)
mistakes(
    "ORDER_ASSUMED",
    "Engines of different order all get the same one.",
    "Run the spring for one fixed time with n, 2n and 4n steps, and compare the ends.",
    kind="consequence",
)
mistakes(
    "ORDER_SIGN",
    "The order has the right size but the wrong sign.",
    "The coarser pair differs more: divide its difference by that of the finer pair.",
)
mistakes(
    "ORDER_STEPS_NOT_HALVED",
    "The result is the order times a factor. Perhaps the number of steps does not double, or the differences are squared.",
    "Use n, 2n and 4n steps, and divide the lengths of the two differences.",
)
mistakes(
    "ORDER_OF_OTHER_DIFFERENCES",
    "Both differences are taken from the coarsest run.",
    "Divide the difference of the first two runs by that of the last two: |y1 - y2| by |y2 - y3|.",
)
mistakes(
    "ORDER_AGAINST_FINEST",
    "A method of first order gets 2, as with both differences taken from the finest run, or with a finest run that is not four times as fine as the coarsest.",
    "The runs have n, 2n and 4n steps. Divide the difference of the first two by that of the last two: |y1 - y2| by |y2 - y3|.",
)
mistakes(
    "ORDER_ROUNDED_DOWN",
    "Some orders are off by one. Perhaps the slope is cut: 1.98 becomes 1.",
    "int() drops the decimals and math.ceil rounds up: use round().",
).edit(
    "characterise",
    {"return round(": "return int(", "end(16), end(32), end(64)": "end(20), end(40), end(80)"},
    of="_order",
)
mistakes(
    "ORDER_TIME_NOT_FIXED",
    "The runs that are compared end at different times.",
    "Run for one fixed time: with n steps of T/n, then 2n of T/(2n), then 4n of T/(4n).",
)
mistakes(
    "ORDER_STEPS_TOO_LARGE",
    "The orders are those of very large steps.",
    "Make the largest of the three steps about a tenth of 1/omega.",
)

# -- symplectic

mistakes(
    "SYMPLECTIC_INVERTED",
    "Yes and no are exchanged.",
    "Symplectic means that the determinant is one: return abs(det - 1) < 1e-6.",
)
mistakes(
    "SYMPLECTIC_TOLERANCE",
    "Engines that change the area a little in every step pass the test. Is the threshold too wide, or the step too short?",
    "Test abs(det - 1) < 1e-6 at h = 0.5/omega.",
).edit("characterise", {") - 1) < 1e-6": ") - 1) < 4e-3"})
mistakes(
    "SYMPLECTIC_BY_ENERGY",
    "The answers are those of a test for energy. An accurate method nearly keeps the energy without keeping area.",
    "Build the matrix of one step from two runs with n = 1, and look at its determinant.",
)
mistakes(
    "SYMPLECTIC_SOME_REFUSED",
    "Some engines that keep area are refused.",
    "Test abs(det - 1) < 1e-6 and nothing else: rounding and jitter need that room.",
    kind="consequence",
)
mistakes(
    "DAMPING_ROWS_COUNTED",
    "The rate is too small by about one part in n, as where rows are counted for steps, or the last row is left out.",
    "Between n + 1 rows there are n steps: divide by n times h. The last row belongs to the time n h.",
)
mistakes(
    "DAMPING_OTHER_SCENE",
    'No run was made in the scene "free". In the others, more than the damping can change the speed.',
    'Take a free body without a force: engine.run("free", ...).',
)
mistakes(
    "PUSHED_IN_THE_AIR",
    "Every push began with the body above the floor, where no friction holds it.",
    "Let the body come to rest on the floor first, and start each push from where it then lies.",
    kind="consequence",
).edit(
    "characterise", {"_settled(engine, info), round": '[0, 0, info["radius"] + 0.3], round'}, of="_anisotropy"
)
mistakes(
    "PUSHED_TOO_SOFTLY",
    "No push was harder than about mu m g, and an engine may hold more than that.",
    "The least force is below 5 mu m g: search up to there.",
    kind="consequence",
)
mistakes(
    "PUSHED_TOO_SELDOM",
    "Only a few pushes were tried for each engine.",
    "Bisect each force: ten halvings from 5 mu m g leave half a per cent of mu m g.",
    kind="consequence",
)
mistakes(
    "DAMPING_SIGN",
    "For at least one engine the rate is negative.",
    "The rate is ln(v0/v) over the time between the two speeds, v0 at the start and v at the end. In too short a time the jitter is larger than the loss: take about dt/10.",
)
mistakes(
    "DAMPING_AS_FORCE",
    "The result is the rate times the mass.",
    "The report asks for the rate of the velocity itself, in 1/s: leave the mass out.",
)
mistakes(
    "DAMPING_ASSUMED",
    "The result is zero, or nearly so, also for engines that slow a free body down.",
    "Give a free body a velocity v0 and no force, and see how fast it is some time later: the rate is ln(v0/v) over that time.",
)
mistakes(
    "DAMPING_OTHER_LOG",
    "The rate is what a logarithm to base two or ten gives.",
    "Use the natural logarithm, math.log.",
)
mistakes(
    "DAMPING_TIME_CONSTANT",
    "The result is a time: one over the rate, or ln 2 over it.",
    "The report asks for the rate, -d ln|v|/dt, in 1/s.",
)
mistakes(
    "DAMPING_OVER_ONE_STEP",
    "What a whole run loses is divided by the time of a single step.",
    "Divide by the time that passed between the two speeds: n steps of h.",
)
mistakes(
    "LIMIT_NEVER_SEEN",
    "An engine that does become unstable is called stable at every step.",
    "Go up from 0.05/omega to 10/omega, in increments of less than 1/omega. The states after one step are the columns of its matrix: look at the largest modulus of its eigenvalues.",
    kind="nan",
).edit("characterise", {"low >= 10:": "low >= 10 * omega:"}, of="_max_stable_z")
mistakes(
    "STABLE_BY_DETERMINANT",
    "Engines that keep area are called stable at any step. The determinant is the product of the eigenvalues: one may be large while the other is small.",
    "Look at the largest modulus alone: max(abs(np.linalg.eigvals(M))).",
)
mistakes(
    "TOLERANCE_TOO_TIGHT",
    "Engines that keep area are called unstable too early.",
    "Unstable means that an eigenvalue of one step's matrix on (q, v/omega) has a modulus above 1 + 1e-8. Stable steps of these engines have eigenvalues of modulus 1: with a limit of exactly 1, rounding decides. A run that stays bounded may still swing further than it started.",
    kind="consequence",
)
mistakes(
    "LIMIT_AT_ONCE",
    "At least one engine that is stable for longer is called unstable at 0.05/omega, or next to it.",
    "Unstable means that an eigenvalue of one step's matrix on (q, v/omega) has a modulus above 1 + 1e-8. Whether one state grows in one step does not tell.",
    kind="consequence",
).body(
    "characterise",
    """
        def stable(z):
            q, v = engine.run("spring", [1.0], [omega], z / omega, 1, [0.0])
            return math.hypot(q[-1][0], v[-1][0] / omega) <= math.sqrt(2) * (1 + 1e-8)

        low = 0.05
        if not stable(low):
            return 0.0
        while stable(low + 0.5):
            low += 0.5
            if low >= 10:
                return math.inf
        return _bisect(stable, low, low + 0.5, 0.004 * low)
    """,
    of="_max_stable_z",
)
mistakes(
    "LIMIT_COARSE",
    "No limit is far off, but at least one is off by more than 1 %.",
    "Bisect between a stable step and the next unstable one. Check the matrix, on (q, v/omega), its largest modulus, and the threshold 1 + 1e-8.",
    kind="consequence",
)
mistakes(
    "STABLE_BY_TRACE",
    "The limits are those of a test by the trace.",
    "Look at the largest modulus: max(abs(np.linalg.eigvals(M))).",
)
mistakes(
    "EIGENVALUES_WITHOUT_MODULUS",
    "The limits are those of a test by the real part of the eigenvalues.",
    "abs() of a complex number is its modulus: max(abs(np.linalg.eigvals(M))).",
)
mistakes(
    "SMALLEST_EIGENVALUE",
    "The limits are those of a test by the smallest eigenvalue.",
    "The largest one decides: max(abs(np.linalg.eigvals(M))) must not exceed 1 + 1e-8.",
)
mistakes(
    "STABLE_BY_NORM",
    "The limits are those of a norm of the matrix, of eigvalsh, or of a matrix that is not on (q, v/omega): one of these.",
    "Look at the largest modulus: max(abs(np.linalg.eigvals(M))). A stable step may enlarge the state once, so a norm says too little, and eigvalsh is for symmetric matrices alone. If you use eigvals, see that the matrix is on (q, v/omega): start from (1, 0) and (0, omega), and divide both resulting velocities by omega.",
)
mistakes(
    "TOLERANCE_TOO_LOOSE",
    "Methods that grow a little in every step count as stable.",
    "Unstable means a modulus above 1 + 1e-8: a thousandth in each step is a factor of e after a thousand steps.",
)
mistakes(
    "DIAGONAL_SUM",
    "The ratio is too large by the square root of two, as if the two components of the diagonal force were added.",
    "Push with (F cos 45°, F sin 45°, 0) and report F: components add up by their squares.",
)
mistakes(
    "ANISOTROPY_IS_DIFFERENCE",
    "The result is a difference of the two forces, not their ratio.",
    "Divide them: F(45 degrees) / F(0 degrees).",
)
mistakes(
    "ANISOTROPY_IS_FORCE",
    "The result is one of the two forces, in N.",
    "The report asks for their ratio: F(45 degrees) / F(0 degrees).",
)
mistakes(
    "ANISOTROPY_IS_COEFFICIENT",
    "The result is a coefficient of friction.",
    "The report asks for the ratio of two forces: the diagonal one divided by the one along x.",
)
mistakes(
    "ANISOTROPY_BY_FORMULA",
    "One of the two forces is computed as mu m g, not measured.",
    "Measure both forces: push along x, and along the diagonal.",
)
mistakes(
    "ANGLE_IN_DEGREES",
    "At least one push went in another direction than 0 or 45 degrees.",
    "cos and sin take radians: math.radians(45).",
)
mistakes(
    "PENETRATION_ABSOLUTE",
    "An engine that keeps bodies at a distance gets a positive depth.",
    "A body that hovers has not sunk in: use max(0, radius - z), not abs(radius - z).",
)
mistakes(
    "PENETRATION_HEIGHT",
    "The result is as large as the height of the centre.",
    "Subtract it from the radius, which info() returns: max(0, radius - z).",
)
mistakes(
    "PENETRATION_NOT_IN_METRES",
    "The depth is in another unit than metres.",
    "The report asks for metres.",
)
mistakes(
    "PENETRATION_RELATIVE",
    "The result is the depth divided by the body's size.",
    "The report asks for metres, so do not divide.",
)
mistakes(
    "PENETRATION_ASSUMED",
    "The result is zero, or nearly so, also for engines with soft contact.",
    "Place the body on the floor at z = radius, wait five seconds, and report max(0, radius - z) of the last sample.",
)
mistakes(
    "RESTITUTION_NO_HIT",
    "On each engine whose ratio is wrong, your body at 2 m/s does not reach the wall before the run ends.",
    "Start near -(radius + wall_thickness/2), and take so many steps that the velocity is seen to turn, or to become 0.",
    kind="consequence",
).body(
    "characterise",
    """
        start = -(info["radius"] + info["wall_thickness"] / 2) - 0.02
        q, v = engine.run("wall", [start], [2.0], info["dt"], 2, [0])
        return abs(v[-1][0] / v[0][0]), -info["radius"] - info["wall_thickness"] / 2
    """,
    of="_slow_hit",
)
mistakes(
    "STOPPED_BODY_OVERLOOKED",
    "Only an engine whose wall stops a body dead gets a wrong ratio: it should be 0.",
    "There the velocity becomes 0 and not negative. Look for the first sample with v <= 0.",
    kind="consequence",
).edit(
    "characterise",
    {
        "next(i for i in range(11) if v[i][0] <= 0)": "next((i for i in range(11) if v[i][0] < 0), None)",
        "return -v": "if hit is None:\n        return 1.0, q[-1][0]\n    return -v",
    },
    of="_slow_hit",
)
mistakes(
    "RESTITUTION_LOSS",
    "The result is what is lost at the wall, not what is kept.",
    "Divide the speed after the hit by the speed before it.",
)
mistakes(
    "RESTITUTION_INVERTED",
    "The result is as large as one over the right ratio.",
    "The speed after the hit is the numerator.",
)
mistakes(
    "RESTITUTION_SPEED_AFTER",
    "The result is the speed after the hit.",
    "Divide by the speed before the hit.",
)
mistakes(
    "RESTITUTION_ASSUMED",
    "Engines of different restitution get the same value, or nearly the same.",
    "Send a body against the wall at 2 m/s, and compare the speeds just before the hit and just after it. Does the body reach the wall?",
)
mistakes(
    "TUNNEL_UNSAFE_REPORTED",
    "In your own runs, a body gets through at the speed that you report or at a lower one.",
    "A speed is safe only if no start gets through. Report the largest safe one.",
    kind="fact",
)
mistakes(
    "TUNNEL_START_ELSEWHERE",
    "Most fast bodies do not start in [-1 - v dt, -1].",
    "Start there, whatever the speed, from many places spread over it. Take n so large that n dt v is 2 m + v dt or more.",
    kind="consequence",
)
mistakes(
    "TUNNEL_SPEEDS_APART",
    "The speeds that were tried lie too far apart: the right one is between the reported one and the next.",
    "Bisect between a safe speed and an unsafe one until they are less than 5 % apart.",
    kind="consequence",
).body(
    "characterise",
    """
        dt = info["dt"]

        def stopped(speed):
            n = math.ceil(4 / (speed * dt)) + 3
            starts = [-1 - speed * dt * k / 40 for k in range(40)]
            return all(engine.run("wall", [s], [speed], dt, n, [0])[0][-1][0] < 0 for s in starts)

        speed = 8.0
        while stopped(1.5 * speed):
            speed *= 1.5
            if speed > 200:
                return math.inf
        return speed
    """,
    of="_tunnelling_speed",
)
mistakes(
    "TUNNEL_RUNS_SHORT",
    "Most runs end before the body would have gone 2 m.",
    "Take n so large that n dt v is 2 m + v dt or more. For each speed, try many starts over all of [-1 - v dt, -1].",
    kind="consequence",
)
mistakes(
    "TUNNEL_STARTS_NARROW",
    "The starts for one speed often do not cover the way of a whole step.",
    "Spread many of them evenly over all of [-1 - v dt, -1].",
    kind="consequence",
)
mistakes(
    "TUNNEL_WITHOUT_RADIUS",
    "The results are the wall's thickness, or half of it, divided by dt.",
    "The body has a size, and engines look for contact in different ways: shoot bodies at the wall.",
)
mistakes(
    "TUNNEL_IN_STEPS",
    "The result is a distance per step.",
    "The report asks for a speed in m/s: do not multiply by dt.",
)
mistakes(
    "DETERMINISM_NOT_COMPARED",
    "Every engine is called deterministic, also one whose runs differ.",
    "Make the same run of a moving body twice, and compare every number of both with np.array_equal.",
    kind="consequence",
)
mistakes(
    "DETERMINISM_AT_REST",
    "Every engine is called deterministic. The runs that were made twice were of a body at rest at 0.",
    "Repeat a run in which a body moves.",
    kind="consequence",
)
mistakes(
    "DETERMINISM_INVERTED",
    "The answers are the opposite of the right ones.",
    "True means that the two runs agree.",
)
mistakes(
    "NOT_MEASURED",
    "",
    "Measure it as the README says, and store the value under this key.",
    kind="fact",
)
mistakes(
    "OTHER_STEP_THAN_DT",
    "The value comes from runs with a step other than the engine's own dt.",
    "Contact may behave differently with another step, so this key is defined at dt, which info() returns.",
)
mistakes(
    "SETTLED_ELSEWHERE",
    "Where this value is wrong, no body was put on the floor of that engine and left alone there: its state at rest comes from elsewhere.",
    "Let a body settle on each engine that is given, and keep nothing from one call to the next.",
    kind="fact",
).program(
    "characterise",
    """
        _settle, _AT_REST = _settled, {}


        def _settled(engine, info):
            if info["dt"] not in _AT_REST:
                _AT_REST[info["dt"]] = _settle(engine, info)
            return _AT_REST[info["dt"]]
    """,
)
mistakes(
    "NEVER_CHOOSES",
    "Your code returns None, also where several engines fit.",
    "Return the name of the cheapest engine that fits. Does a return inside the loop come too early?",
    kind="consequence",
)
mistakes(
    "REQUIREMENTS_IGNORED",
    "Your code picks the cheapest engine, whatever is required.",
    "Keep only the engines that meet every requirement, then take the cheapest of those.",
)
mistakes(
    "DEPENDS_ON_ORDER",
    "With the same reports in another order, your code picks another engine.",
    "Compare the costs of all engines that fit, as they are, wherever they stand in the dict.",
)
mistakes(
    "NOT_A_NAME",
    "Your code does not return one of the names it was given.",
    "Return the key of the chosen report, or None.",
)
mistakes(
    "ZERO_TAKEN_FOR_MISSING",
    "A value of zero or False is treated as not measured.",
    "0 and False count as false, too: test `is None`.",
)
mistakes(
    "LIMIT_NOT_SCALED",
    "The matrix is not that of (q, v/omega).",
    "Start from (1, 0) and (0, omega), and divide both resulting velocities by omega.",
)
mistakes(
    "BOOLS_NOT_MEASURED",
    "A value of True or False is treated as not measured.",
    "Test `is None` alone, and leave the type of a value aside.",
)
mistakes(
    "EQUALITY_OF_TRUTH",
    'For "==", two different values that are not zero count as equal.',
    "Compare the values themselves, without bool().",
)
mistakes(
    "INFINITE_TAKEN_FOR_MISSING",
    "A value of infinity is treated as not measured.",
    "An infinite tunnelling speed was measured: test `is None` alone.",
)
mistakes(
    "OPERATOR_NEVER_MET",
    "Requirements with one of the operators are treated as not met, even where they are.",
    "Handle each of the three operators, as they are spelled in the README.",
)
mistakes(
    "OPERATOR_IGNORED",
    "Requirements with one of the operators are treated as met, even where they are not.",
    "Handle each of the three operators.",
)
mistakes(
    "DATE_AHEAD",
    "The date of a fact lies in the future.",
    "as_of is the day on which you checked that the fact was true.",
    kind="fact",
)
mistakes(
    "OPTION_TAKEN_FOR_DEFAULT",
    "The engine has this integrator as an option, not as its default.",
    "Look for the default of this option in the engine's own manual.",
    kind="fact",
)
mistakes(
    "STEP_IN_MILLISECONDS",
    "The step is the engine's own, in milliseconds.",
    "The field is in seconds: divide by 1000.",
    kind="fact",
)


choosing = kit.sibling(__file__, "choosing")


model = kit.sibling(__file__, "engine_comparison")


@mistakes.more
def hypotheses():
    """Task, codes of what is wrong, and function of each, those with one mistake first."""
    for key, forms in _KEYS.items():
        for code, measure in forms:
            yield "characterise", (code,), _with(key, measure)
        # Two at once: a value that another mistake gives, changed as well.
        firsts = dict(reversed(forms)).items()
        for (code, change), (other, measure) in itertools.product(_CHANGES.get(key, ()), firsts):
            if code != other and _ALONE.isdisjoint((code, other)):
                yield "characterise", (other, code), _with(key, _changed(measure, change))
    for code, forms in choosing.METS.items():
        for met in forms:
            yield "choose_engine", (code,), _choosing(choosing.choose, met)
    for code, forms in choosing.CHOICES.items():
        for choice in forms:
            yield "choose_engine", (code,), _choosing(choice, choosing.meets)
    for (one, mets), (other, forms) in itertools.product(choosing.METS.items(), choosing.CHOICES.items()):
        for met, choice in itertools.product(mets[:1], forms[:1]):
            yield "choose_engine", (one, other), _choosing(choice, met)


def _choosing(choice, met):
    return lambda reports, requirements: choice(reports, requirements, met=met)


def _with(key, measure):
    """``characterise`` with one key measured by ``measure(engine, info)``."""

    def characterise(engine):
        info = engine.info()
        measures = _RIGHT | {key: measure}  # nothing is run for the key that is measured in another way
        return {each: of(engine, info) for each, of in measures.items()}

    return characterise


_RIGHT = {
    "order": lambda engine, info: model._order(engine, info["omega"]),
    "symplectic": lambda engine, info: _area()(engine, info),
    "linear_damping": lambda engine, info: model._linear_damping(engine, info["dt"]),
    "max_stable_step": lambda engine, info: model._max_stable_z(engine, info["omega"]) / info["omega"],
    "friction_anisotropy": model._anisotropy,
    "rest_penetration": lambda engine, info: max(0.0, info["radius"] - model._settled(engine, info)[2]),
    "restitution": lambda engine, info: model._slow_hit(engine, info)[0],
    "tunnelling_speed": model._tunnelling_speed,
    "deterministic": lambda engine, info: model._deterministic(engine, info["dt"]),
}


def _of(key, change):
    """The right value, changed: ``change(value, info)``."""
    return _changed(_RIGHT[key], change)


def _changed(measure, change):
    return lambda engine, info: change(measure(engine, info), info)


#: Mistakes that change a value when it is measured.
_CHANGES = {
    "symplectic": (("SYMPLECTIC_INVERTED", lambda value, _: not value),),
    "linear_damping": (
        ("DAMPING_SIGN", lambda c, _: -c),
        ("DAMPING_OTHER_LOG", lambda c, _: c / math.log(10)),
        ("DAMPING_OTHER_LOG", lambda c, _: c / math.log(2)),
        ("DAMPING_AS_FORCE", lambda c, info: c * info["mass"]),
        ("DAMPING_PER_STEP", lambda c, info: c * info["dt"] / 1000),
        ("DAMPING_PER_STEP", lambda c, info: c * info["dt"]),
        ("DAMPING_OVER_ONE_STEP", lambda c, _: c * 100),
        ("DAMPING_OF_ENERGY", lambda c, _: 2 * c),
    ),
    "max_stable_step": (("RETURNS_Z", lambda h, info: h * info["omega"]),),
    "rest_penetration": (
        ("PENETRATION_NOT_IN_METRES", lambda depth, _: 1000 * depth),
        ("PENETRATION_NOT_IN_METRES", lambda depth, _: 100 * depth),
    ),
    "restitution": (
        ("RESTITUTION_SIGN", lambda e, _: -e),
        ("RESTITUTION_SQUARED", lambda e, _: e * e),
        ("RESTITUTION_INVERTED", lambda e, _: 1 / e if e else math.inf),
        ("RESTITUTION_LOSS", lambda e, _: 1 - e),
    ),
}


#: Words that are not true beside those of a second mistake.
_ALONE = {"DAMPING_OF_ENERGY", "DAMPING_OF_ENVELOPE", "DAMPING_TIME_CONSTANT", "DAMPING_ASSUMED"}
_ALONE |= {"LIMIT_ASSUMED", "LIMIT_COARSE", "RESTITUTION_INVERTED", "RESTITUTION_LOSS", "RESTITUTION_ASSUMED"}
_ALONE |= {"PENETRATION_HEIGHT", "VALUE_ROUNDED"}


def _changes(key):
    """Each of these alone."""
    return ((code, _of(key, change)) for code, change in _CHANGES[key])


def _order(ns=(16, 32, 64), start=(1.0, 0.7), span=1.3, log=math.log2, whole=round, gaps=None, turn=False):
    """``gaps``: which two numbers the ends y1, y2, y3 are made into."""
    gaps = gaps or (lambda y: (np.linalg.norm(y[0] - y[1]), np.linalg.norm(y[1] - y[2])))

    def measure(engine, info):
        omega = info["omega"]

        def end(n):
            q, v = engine.run("spring", [start[0]], [start[1] * omega], span / omega / n, n, [0.0])
            return np.array([q[-1][0], 0.0 if turn else v[-1][0] / omega])

        coarse, fine = gaps([end(n) for n in ns])
        return whole(log(coarse / fine))

    return measure


def _against_exact(start=(1.0, 0.7), span=1.3):
    turned = start[0] * math.cos(span) + start[1] * math.sin(span)
    moving = start[1] * math.cos(span) - start[0] * math.sin(span)
    exact = np.array([turned, moving])
    return _order(
        (32, 64, 64), start, span, gaps=lambda y: (np.linalg.norm(y[0] - exact), np.linalg.norm(y[1] - exact))
    )


def _same_step(engine, info):
    omega = info["omega"]

    def end(n):
        q, v = engine.run("spring", [1.0], [0.7 * omega], 0.05 / omega, n, [0.0])
        return np.array([q[-1][0], v[-1][0] / omega])

    y = [end(n) for n in (16, 32, 64)]
    return round(math.log2(np.linalg.norm(y[0] - y[1]) / np.linalg.norm(y[1] - y[2])))


def _to_the_coarsest(y):
    return np.linalg.norm(y[0] - y[1]), np.linalg.norm(y[0] - y[2])


def _to_the_finest(y):
    return np.linalg.norm(y[0] - y[2]), np.linalg.norm(y[1] - y[2])


def _squares(y):
    return np.sum((y[0] - y[1]) ** 2), np.sum((y[1] - y[2]) ** 2)


def _upside_down(y):
    return np.linalg.norm(y[1] - y[2]), np.linalg.norm(y[0] - y[1])


def _down(x):
    return int(x)


_ORDER = (
    ("ORDER_AGAINST_UNDAMPED", _against_exact()),
    ("ORDER_AGAINST_UNDAMPED", _against_exact((1.0, 0.0), 1.0)),
    ("ORDER_LOCAL", _of("order", lambda p, _: p + 1)),
    ("ORDER_SIGN", _order(gaps=_upside_down)),
    ("ORDER_WITHOUT_LOG", _order(log=lambda x: x)),
    ("ORDER_OTHER_LOG", _order(log=math.log)),
    ("ORDER_OTHER_LOG", _order(log=math.log10)),
    ("ORDER_STEPS_NOT_HALVED", _order((16, 64, 256))),
    ("ORDER_STEPS_NOT_HALVED", _order((10, 100, 1000))),
    ("ORDER_STEPS_NOT_HALVED", _order((16, 48, 144))),
    ("ORDER_STEPS_NOT_HALVED", _order(gaps=_squares)),
    ("ORDER_OF_OTHER_DIFFERENCES", _order(gaps=_to_the_coarsest)),
    ("ORDER_OF_OTHER_DIFFERENCES", _order(gaps=lambda y: _to_the_coarsest(y)[::-1])),
    *(
        ("ORDER_NOT_THREE", _of("order", lambda p, _, other=other: other if p == 3 else p))
        for other in (2, 4)
    ),
    ("ORDER_AGAINST_FINEST", _order(gaps=_to_the_finest)),
    ("ORDER_ROUNDED_DOWN", _order(whole=_down)),
    ("ORDER_ROUNDED_DOWN", _order((32, 64, 128), whole=_down)),
    ("ORDER_ROUNDED_DOWN", _order(whole=math.ceil)),
    ("ORDER_TIME_NOT_FIXED", _same_step),
    ("ORDER_AT_TURNING_POINT", _order(start=(1.0, 0.0), span=math.pi, turn=True)),
    ("ORDER_AT_TURNING_POINT", _order(start=(1.0, 0.0), span=2 * math.pi, turn=True)),
    ("ORDER_AT_TURNING_POINT", _order((64, 128, 256), (1.0, 0.0), math.pi, turn=True)),
    ("ORDER_AT_TURNING_POINT", _order((64, 128, 256), (1.0, 0.0), 2 * math.pi, turn=True)),
    ("ORDER_AT_TURNING_POINT", _order(start=(1.0, 0.0), span=2 * math.pi)),
    ("ORDER_IN_ROUNDING", _order((4000, 8000, 16000))),
    ("ORDER_IN_ROUNDING", _order((2000, 4000, 8000))),
    ("ORDER_STEPS_TOO_LARGE", _order((2, 4, 8), span=5.3)),
    *(("ORDER_STEPS_TOO_LARGE", _order((1, 2, 4), span=span)) for span in (5.3, 2.0, 1.3, 1.0)),
    ("ORDER_ASSUMED", lambda engine, info: 1),
    ("ORDER_ASSUMED", lambda engine, info: 2),
)


def _step(engine, info, z, back=True, scaled=True):
    """The matrix of a spring step of h omega = z; ``back``: velocities are divided by omega again."""
    omega = info["omega"]
    columns = []
    for q0, v0 in ((1.0, 0.0), (0.0, omega if scaled else 1.0)):
        q, v = engine.run("spring", [q0], [v0], z / omega, 1, [0.0])
        columns.append((q[1][0], v[1][0] / (omega if back else 1.0)))
    return np.transpose(columns)


def _area(z=0.5, least=1e-6, looks=lambda det, least: abs(det - 1) < least, **kinds):
    return lambda engine, info: bool(looks(np.linalg.det(_step(engine, info, z, **kinds)), least))


def _energy(steps, z, least, sided=False):
    def measure(engine, info):
        q, v = engine.run("spring", [1.0], [0.0], z / info["omega"], steps, [0.0])
        change = q[-1][0] ** 2 + (v[-1][0] / info["omega"]) ** 2 - 1
        return bool((change if sided else abs(change)) < least)

    return measure


_SYMPLECTIC = (
    *_changes("symplectic"),
    ("STABLE_TAKEN_FOR_SYMPLECTIC", _area(looks=lambda det, least: det - 1 < least)),
    ("STABLE_TAKEN_FOR_SYMPLECTIC", _area(looks=lambda det, least: abs(det) <= 1 + least)),
    ("SYMPLECTIC_TOLERANCE", _area(least=1e-2)),
    ("SYMPLECTIC_TOLERANCE", _area(least=0.1)),
    ("SYMPLECTIC_TOLERANCE", _area(least=1e-3)),
    ("SYMPLECTIC_STEP_TOO_SMALL", _area(z=1e-3)),
    ("SYMPLECTIC_STEP_TOO_SMALL", _area(z=0.01)),
    ("SYMPLECTIC_NEVER", _area(back=False)),
    ("SYMPLECTIC_NEVER", _area(scaled=False)),
    ("SYMPLECTIC_BY_ENERGY", _energy(100, 0.05, 0.1)),
    ("SYMPLECTIC_BY_ENERGY", _energy(1000, 0.05, 0.1)),
    ("SYMPLECTIC_BY_ENERGY", _energy(1000, 0.05, 0.01)),
    ("SYMPLECTIC_BY_ENERGY", _energy(100, 0.05, 0.01)),
    ("SYMPLECTIC_BY_ENERGY", _energy(1000, 0.01, 0.01)),
    ("SYMPLECTIC_BY_ENERGY", _energy(1000, 0.01, 0.05)),
    ("SYMPLECTIC_BY_ENERGY", _energy(1, 0.5, 0.1)),
)


def _at_dt(divisor, rate):
    def measure(engine, info):
        h = info["dt"] / divisor
        _, v = engine.run("free", [0.0], [1.0], h, 100, [0.0])
        return rate(v, h)

    return measure


def _envelope(engine, info):
    omega, h, n = info["omega"], info["dt"] / 50, 5000
    q, v = engine.run("spring", [1.0], [0.0], h, n, [0.0])
    return -math.log(math.hypot(q[-1][0], v[-1][0] / omega)) / (n * h)


_DAMPING = (
    ("DAMPING_ASSUMED", lambda engine, info: 0.0),
    *_changes("linear_damping"),
    ("DAMPING_OF_ENVELOPE", _of("linear_damping", lambda c, _: c / 2)),
    ("DAMPING_OF_ENVELOPE", _envelope),
    ("DAMPING_TIME_CONSTANT", _of("linear_damping", lambda c, _: 1 / c if c > 1e-9 else 0.0)),
    ("DAMPING_TIME_CONSTANT", _of("linear_damping", lambda c, _: 1 / c if c > 1e-9 else math.inf)),
    ("DAMPING_TIME_CONSTANT", _of("linear_damping", lambda c, _: math.log(2) / c if c > 1e-9 else math.inf)),
    ("DAMPING_AT_DT", _at_dt(1, lambda v, h: -math.log(v[-1][0]) / (100 * h))),
    ("DAMPING_AT_DT", _at_dt(1, lambda v, h: (1 - v[1][0]) / h)),
    ("DAMPING_AT_DT", _at_dt(2, lambda v, h: -math.log(v[-1][0]) / (100 * h))),
)


def _radius(m):
    return max(abs(np.linalg.eigvals(m)))


def _search(
    size=_radius, limit=1 + 1e-8, walk=0.5, last=10.0, endless=math.inf, unstable=0.0, fine=True, **kinds
):
    """``unstable``: what is returned where the first step fails, None for that step itself."""

    def measure(engine, info):
        omega = info["omega"]

        def stable(z):
            return bool(size(_step(engine, info, z, **kinds)) <= limit)

        low = 0.05
        if not stable(low):
            return unstable if unstable is not None else low / omega
        while stable(low + walk):
            low += walk
            if low >= last:
                return endless if endless is not None else last / omega
        return (model._bisect(stable, low, low + walk, 0.004 * low) if fine else low) / omega

    return measure


def _jumped(last):
    """One bisection over the whole range."""

    def measure(engine, info):
        def stable(z):
            return bool(_radius(_step(engine, info, z)) <= 1 + 1e-8)

        if not stable(0.05):
            return 0.0
        return math.inf if stable(last) else model._bisect(stable, 0.05, last, 0.001 * last) / info["omega"]

    return measure


def _from_above(engine, info):
    z = 10.0
    while z > 0.05 and not _radius(_step(engine, info, z)) <= 1 + 1e-8:
        z -= 0.01
    return math.inf if z >= 10 else z / info["omega"] if z > 0.05 else 0.0


def _by_eye(steps, most):
    def measure(engine, info):
        omega = info["omega"]

        def stable(z):
            q, _ = engine.run("spring", [1.0], [0.0], z / omega, steps, [0.0])
            return bool(np.all(np.isfinite(q)) and abs(q[-1][0]) < most)

        low = 0.05
        if not stable(low):
            return 0.0
        while stable(low + 0.5):
            low += 0.5
            if low >= 10:
                return math.inf
        return model._bisect(stable, low, low + 0.5, 0.004 * low) / omega

    return measure


#: What is taken for the largest modulus. The walk decides which of its limits is found.
_SIZES = (
    ("STABLE_BY_DETERMINANT", lambda m: abs(np.linalg.det(m))),
    ("STABLE_BY_TRACE", lambda m: abs(np.trace(m)) / 2),
    ("EIGENVALUES_WITHOUT_MODULUS", lambda m: np.linalg.eigvals(m).real.max()),
    ("EIGENVALUES_WITHOUT_MODULUS", lambda m: abs(np.linalg.eigvals(m).real).max()),
    ("SMALLEST_EIGENVALUE", lambda m: min(abs(np.linalg.eigvals(m)))),
    ("STABLE_BY_NORM", lambda m: np.linalg.norm(m, 2)),
    ("STABLE_BY_NORM", np.linalg.norm),
    ("STABLE_BY_NORM", lambda m: abs(np.linalg.eigvalsh(m)).max()),
)
_WALKS = (0.5, 0.2, 0.05)


_STABLE = (
    ("LIMIT_ASSUMED", lambda engine, info: 2 / info["omega"]),
    ("LIMIT_ASSUMED", lambda engine, info: math.sqrt(2) / info["omega"]),
    *_changes("max_stable_step"),
    *((code, _search(size, walk=walk)) for code, size in _SIZES for walk in _WALKS),
    ("TOLERANCE_TOO_TIGHT", _search(limit=1 - 1e-12)),
    ("TOLERANCE_TOO_LOOSE", _search(limit=1.01)),
    ("TOLERANCE_TOO_LOOSE", _search(limit=1.001)),
    ("TOLERANCE_TOO_LOOSE", _search(limit=1.05)),
    ("TOLERANCE_TOO_LOOSE", _search(limit=1.1)),
    ("LIMIT_FROM_ABOVE", _jumped(10.0)),
    ("LIMIT_FROM_ABOVE", _from_above),
    ("LIMIT_FROM_ABOVE", _search(walk=4.0)),
    *(("LIMIT_NOT_SCALED", _search(scaled=False, walk=walk)) for walk in _WALKS),
    ("LIMIT_COARSE", _search(fine=False)),
    ("LIMIT_COARSE", _search(walk=0.25, fine=False)),
    ("NO_INFINITY", _search(endless=None)),
    ("NO_INFINITY", _search(endless=0.0)),
    ("NO_ZERO", _search(unstable=None)),
    ("NO_ZERO", _search(unstable=math.inf)),
    *(("NO_ZERO", _by_eye(steps, most)) for steps in (100, 300, 1000) for most in (2.0, 10.0, 1e3)),
)


_ROOT = math.sqrt(0.5)


def _forces(diagonal=(_ROOT, _ROOT), straight=(1.0, 0.0), settled=True, slides=0.01, steps=1.0):
    """The least forces along two directions."""

    def of(engine, info):
        dt = info["dt"] / steps
        start = model._settled(engine, info) if settled else [0.0, 0.0, info["radius"]]
        n, most = round(0.5 / dt), 5 * info["mu"] * info["mass"] * info["g"]

        def least(direction):
            def sticks(force):
                push = [force * direction[0], force * direction[1], 0.0]
                _, v = engine.run("floor", start, [0.0] * 3, dt, n, push)
                return max(math.hypot(a, b) for a, b, _ in v) <= slides

            return model._bisect(sticks, 0.0, most, 0.001 * most)

        return least(diagonal), least(straight)

    return of


def _ratio(of=None, made=lambda diagonal, straight, info: diagonal / straight, **how):
    of = of or _forces(**how)
    return lambda engine, info: made(*of(engine, info), info)


_FRICTION = (
    ("ANISOTROPY_ASSUMED", lambda engine, info: 1.0),
    ("ANISOTROPY_ASSUMED", lambda engine, info: math.sqrt(2)),
    ("DIAGONAL_NOT_PUSHED", _ratio(diagonal=(0.0, 1.0))),
    ("ANISOTROPY_INVERTED", _of("friction_anisotropy", lambda ratio, _: 1 / ratio)),
    ("DIAGONAL_COMPONENT", _ratio(diagonal=(1.0, 1.0))),
    ("DIAGONAL_SUM", _of("friction_anisotropy", lambda ratio, _: ratio * math.sqrt(2))),
    ("ANISOTROPY_IS_DIFFERENCE", _ratio(made=lambda d, s, _: d / s - 1)),
    ("ANISOTROPY_IS_DIFFERENCE", _ratio(made=lambda d, s, _: d - s)),
    ("ANISOTROPY_IS_FORCE", _ratio(made=lambda d, s, _: d)),
    ("ANISOTROPY_IS_FORCE", _ratio(made=lambda d, s, _: s)),
    ("ANISOTROPY_IS_COEFFICIENT", _ratio(made=lambda d, s, info: s / info["mass"] / info["g"])),
    ("ANISOTROPY_IS_COEFFICIENT", _ratio(made=lambda d, s, info: d / info["mass"] / info["g"])),
    ("ANISOTROPY_IS_COEFFICIENT", lambda engine, info: info["mu"]),
    ("ANISOTROPY_BY_FORMULA", _ratio(made=lambda d, s, info: d / info["mu"] / info["mass"] / info["g"])),
    ("ANISOTROPY_BY_FORMULA", _ratio(made=lambda d, s, info: info["mu"] * info["mass"] * info["g"] / s)),
    ("ANGLE_IN_DEGREES", _ratio(diagonal=(math.cos(45), math.sin(45)))),
    ("CREEP_TAKEN_FOR_SLIP", _ratio(slides=1e-3)),
    ("CREEP_TAKEN_FOR_SLIP", _ratio(slides=2e-3)),
    ("NOT_SETTLED", _ratio(settled=False)),
)


def _height(engine, info, seconds=5.0, above=0.0, steps=1.0):
    h = info["dt"] / steps
    n = min(20000, max(1, round(seconds / h)))
    q, _ = engine.run("floor", [0.0, 0.0, info["radius"] + above], [0.0] * 3, h, n, [0.0] * 3)
    return [row[2] for row in q]


def _depth(made, **how):
    return lambda engine, info: made(info["radius"], _height(engine, info, **how), info)


def _sunk(radius, z, _):
    return max(0.0, radius - z[-1])


_PENETRATION = (
    ("PENETRATION_HEIGHT", _depth(lambda r, z, _: z[-1])),
    ("PENETRATION_SIGN", _depth(lambda r, z, _: z[-1] - r)),
    ("PENETRATION_SIGN", _depth(lambda r, z, _: max(0.0, z[-1] - r))),
    ("PENETRATION_NEGATIVE", _depth(lambda r, z, _: r - z[-1])),
    ("PENETRATION_ABSOLUTE", _depth(lambda r, z, _: abs(r - z[-1]))),
    ("PENETRATION_TOO_EARLY", _depth(lambda r, z, _: max(0.0, r - min(z)))),
    ("PENETRATION_TOO_EARLY", _depth(lambda r, z, _: max(0.0, r - min(z)), above=0.1)),
    ("PENETRATION_TOO_EARLY", _depth(lambda r, z, _: max(0.0, r - min(z)), above=1.0)),
    ("PENETRATION_TOO_EARLY", _depth(_sunk, seconds=0.05)),
    ("PENETRATION_TOO_EARLY", _depth(_sunk, seconds=0.02)),
    ("PENETRATION_TOO_EARLY", _depth(_sunk, seconds=0.1)),
    *_changes("rest_penetration"),
    ("PENETRATION_RELATIVE", _depth(lambda r, z, _: max(0.0, r - z[-1]) / r)),
    ("PENETRATION_RELATIVE", _depth(lambda r, z, _: max(0.0, r - z[-1]) / (2 * r))),
    ("OTHER_STEP_THAN_DT", _depth(_sunk, steps=2)),
    ("OTHER_STEP_THAN_DT", _depth(_sunk, steps=10)),
    ("PENETRATION_ASSUMED", lambda engine, info: 0.0),
    ("VALUE_ROUNDED", _of("rest_penetration", lambda depth, _: round(float(depth), 2))),
)


def _hit(speed, steps=1.0):
    def measure(engine, info):
        h = info["dt"] / steps
        start = -(info["radius"] + info["wall_thickness"] / 2) - 3.5 * speed * h
        _, v = engine.run("wall", [start], [speed], h, 12, [0.0])
        hit = next((i for i in range(13) if v[i][0] <= 0), None)
        return 1.0 if hit is None else -v[hit][0] / v[hit - 1][0]

    return measure


def _launched(distance, before=2.0):
    """Started so far away, the last speed over that at the start."""

    def measure(engine, info):
        n = math.ceil((distance + 0.6) / (2 * info["dt"]))
        _, v = engine.run("wall", [-distance], [2.0], info["dt"], n, [0.0])
        return abs(v[-1][0]) / before

    return measure


_RESTITUTION = (
    *_changes("restitution"),
    ("RESTITUTION_SQUARED", _of("restitution", lambda e, _: math.sqrt(max(e, 0.0)))),
    ("RESTITUTION_LOSS", _of("restitution", lambda e, _: 1 - e * e)),
    ("RESTITUTION_SPEED_AFTER", _of("restitution", lambda e, _: 2 * e)),
    ("RESTITUTION_ASSUMED", lambda engine, info: 0.0),
    ("RESTITUTION_ASSUMED", lambda engine, info: 1.0),
    ("RESTITUTION_ASSUMED", lambda engine, info: 0.5),
    ("RESTITUTION_OTHER_SPEED", _hit(1.0)),
    ("RESTITUTION_OTHER_SPEED", _hit(0.2)),
    ("RESTITUTION_WITH_DRAG", _launched(1.0)),
    ("RESTITUTION_WITH_DRAG", _launched(0.5)),
)


def _speeds(starts, scale=1.0):
    """Bisection over speeds; ``starts(speed, dt)`` are tried, at dt * scale."""

    def measure(engine, info):
        dt = info["dt"] * scale

        def stopped(speed):
            n = min(20000, math.ceil(4 / (speed * dt)) + 3)
            tried = (engine.run("wall", [s], [speed], dt, n, [0.0])[0][-1][0] for s in starts(speed, dt))
            return all(end < 0 for end in tried)

        return math.inf if stopped(199.9) else model._bisect(stopped, 1.0, 199.9, 0.1)

    return measure


def _spread(count):
    return lambda speed, dt: [-1 - speed * dt * k / count for k in range(count)]


def _geometry(length):
    return lambda engine, info: length(info) / info["dt"]


_TUNNELLING = (
    ("TUNNEL_BY_GEOMETRY", _geometry(lambda info: 2 * info["radius"] + info["wall_thickness"])),
    ("TUNNEL_BY_GEOMETRY", _geometry(lambda info: info["radius"] + info["wall_thickness"] / 2)),
    ("TUNNEL_BY_GEOMETRY", _geometry(lambda info: info["radius"] + info["wall_thickness"])),
    ("TUNNEL_BY_GEOMETRY", _geometry(lambda info: 2 * info["radius"])),
    ("TUNNEL_WITHOUT_RADIUS", _geometry(lambda info: info["wall_thickness"])),
    ("TUNNEL_WITHOUT_RADIUS", _geometry(lambda info: info["wall_thickness"] / 2)),
    ("TUNNEL_NO_INFINITY", _of("tunnelling_speed", lambda v, _: min(v, 200.0))),
    ("TUNNEL_NO_INFINITY", _of("tunnelling_speed", lambda v, _: min(v, 199.0))),
    ("TUNNEL_NO_INFINITY", _of("tunnelling_speed", lambda v, _: 0.0 if math.isinf(v) else v)),
    ("TUNNEL_ONE_START", _speeds(_spread(1))),
    ("TUNNEL_FEW_STARTS", _speeds(_spread(2))),
    ("TUNNEL_FEW_STARTS", _speeds(_spread(3))),
    ("OTHER_STEP_THAN_DT", _speeds(_spread(24), 0.1)),
    ("OTHER_STEP_THAN_DT", _speeds(_spread(24), 0.5)),
    ("TUNNEL_IN_STEPS", _of("tunnelling_speed", lambda v, info: v * info["dt"])),
)


def _twice(agree, q0=1.0, v0=0.5, steps=(50, 50)):
    def measure(engine, info):
        a, b = (engine.run("spring", [q0], [v0], info["dt"], n, [0.0]) for n in steps)
        return bool(agree(np.array(a[0])[-1], np.array(b[0])[-1]))

    return measure


_DETERMINISTIC = (
    ("DETERMINISM_NOT_COMPARED", lambda engine, info: True),
    ("DETERMINISM_TOLERANCE", _twice(np.allclose)),
    ("DETERMINISM_TOLERANCE", _twice(lambda a, b: np.array_equal(np.round(a, 6), np.round(b, 6)))),
    # Of a model that makes other runs twice: what is compared does not show.
    ("DETERMINISM_NOT_COMPARED", _twice(np.array_equal, 0.0, 0.0)),
    ("DETERMINISM_OTHER_RUN", _twice(np.array_equal, steps=(50, 51))),
    ("DETERMINISM_INVERTED", _of("deterministic", lambda value, _: not value)),
)


_KEYS = {
    "order": _ORDER,
    "symplectic": _SYMPLECTIC,
    "linear_damping": _DAMPING,
    "max_stable_step": _STABLE,
    "friction_anisotropy": _FRICTION,
    "rest_penetration": _PENETRATION,
    "restitution": _RESTITUTION,
    "tunnelling_speed": _TUNNELLING,
    "deterministic": _DETERMINISTIC,
}
