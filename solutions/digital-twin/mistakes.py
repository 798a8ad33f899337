"""Mistakes in `digital-twin`: words beside the programs that they are true of."""

from __future__ import annotations

import itertools

from course.authoring.mistakes import Mistakes
from course.scoring import kit

mistakes = Mistakes()

#: A twin without a filter: it predicts in one step, and adds fixed shares of the surprise.
_OBSERVER = """
    dt = t_measured - twin["t"]
    if dt < 0:
        return dict(twin)
    x, v, b = twin["position"], twin["speed"], twin["friction"]
    a = twin["drive"] - b * v
    x, v = x + dt * v + dt * dt / 2 * a, v + dt * a
    surprise = z - x
    x, v = x + 0.3 * surprise, v + 0.3 * surprise
    b = min(max(b - 0.15 * surprise * np.sign(v), 0.05), 5.0)
    return {**twin, "t": t_measured, "position": x, "speed": v, "friction": b, "memory": {}}
"""
#: What makes it predict in steps of a hundredth of a second.
_IN_PARTS = {
    "    a =": "    n = max(1, math.ceil(dt / 0.01))\n    h = dt / n\n    for _ in range(n):\n        a =",
    "x, v = x + dt * v + dt * dt / 2 * a, v + dt * a": "    x, v = x + h * v + h**2 / 2 * a, v + h * a",
}


def _observer(changed):
    """That twin with some texts changed."""
    text = _OBSERVER
    for old, new in changed.items():
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return text


mistakes(
    "TRUNCATES_TOWARD_ZERO",
    "The fraction is cut off, towards zero, so the count around zero is twice as wide as any other.",
    "int() and astype(int) cut towards zero. Use np.floor or np.rint first.",
).edit("encoder", {"np.floor(np.asarray(theta)": "(theta"}).edit(
    "encoder", {"np.floor(np.asarray(theta)": "np.trunc(0.5 + np.asarray(theta)"}
)
mistakes(
    "COUNTS_AS_FLOATS",
    "The counts are right, but their type is not a signed integer type.",
    "A counter has no fractions, so convert the result: .astype(np.int64).",
    kind="fact",
).edit("encoder", {".astype(np.int64)": ""})
mistakes(
    "NEGATIVE_TURNS_CUT",
    "Whole turns are rounded towards zero and the rest downwards, so each negative angle counts one turn too high.",
    "Round once: divide the whole angle by the angle of a count, and take np.floor.",
).body(
    "encoder",
    """
        turns = (np.asarray(theta) / (2 * math.pi)).astype(np.int64)
        rest = np.mod(theta, 2 * math.pi)
        return turns * counts_per_rev + np.floor(rest * counts_per_rev / (2 * math.pi)).astype(np.int64)
    """,
)
mistakes(
    "TURNS_FORGOTTEN",
    "The count starts over after each turn.",
    "An incremental encoder keeps counting, up and down: wrap neither the angle nor the count.",
).edit("encoder", {".astype(np.int64)": ".astype(np.int64) % counts_per_rev"})
mistakes(
    "MUTATES_INPUT",
    "An argument was changed that the caller still needs as it was.",
    "Work on a copy: np.array(x) copies an array and dict(twin) a dict (but copy its memory as well, with its lists and arrays). x = x + ... makes a new array, while x += ... changes the old one.",
    kind="fact",
).body(
    "encoder",
    """
        theta *= counts_per_rev / (2 * math.pi)
        return np.floor(theta).astype(np.int64)
    """,
).edit(
    "lidar",
    {
        "= np.asarray(segments, dtype=float).reshape(-1, 2, 2": "-= np.array([x, y]",
        "(segments[:, 0] - (x, y))": "segments[:, 0]",
    },
).around(
    "delay_line",
    """
        y = _right(x, dt, latency)
        x[dt * np.arange(len(x)) < latency] = 0.0
        return y
    """,
).around(
    "sync",
    """
        twin.update(_right(twin, z, t_measured))
        return dict(twin)
    """,
).around(
    "sync",
    """
        out = _right(dict(twin), z, t_measured)
        twin["drive"] = 0.0
        return out
    """,
).around(
    "sync",
    """
        out = _right({**twin, "memory": twin["memory"].get("own", {})}, z, t_measured)
        twin["memory"].setdefault("seen", []).append([t_measured, z])
        del twin["memory"]["seen"][:-10]
        return {**out, "memory": {"own": out["memory"], "seen": list(twin["memory"]["seen"])}}
    """,
).around(
    "imu",
    """
        measured, bias = _right(np.zeros(len(true)), dt, noise_density, bias_random_walk, bias0, rng)
        true += measured
        return true.copy(), bias
    """,
).around(
    "fit_noise",
    """
        found = _right(still, dt)
        still -= np.mean(still)
        return found
    """,
).body(
    "command",
    """
        twin["drive"] = twin["friction"] * target_speed
        return twin["drive"]
    """,
)
mistakes(
    "WHITE_NOISE_NOT_SCALED_BY_SQRT_DT",
    "The white noise has about the same std at two very different sampling rates.",
    "The noise density is given per square root of hertz. A sample that averages over dt has std noise_density / sqrt(dt), so faster sampling is noisier.",
).edit("imu", {"+ noise_density / math.sqrt(dt) * rng.": "+ noise_density * rng."})
mistakes(
    "WHITE_NOISE_TIMES_SQRT_DT",
    "The white noise decreases with faster sampling, where it should increase.",
    "The std of a sample is noise_density / sqrt(dt). The multiplication by sqrt(dt) belongs to the steps of the bias, which add up over time.",
).edit("imu", {"noise_density / math": "noise_density * math"})
mistakes(
    "BIAS_NOT_RANDOM_WALK",
    "The bias scatters and hardly wanders: it varies about as much over one sample as over ten.",
    "Each bias is the previous bias plus a step: bias0 + np.cumsum(steps), with a 0 in front.",
).edit(
    "imu",
    {
        # The root of two makes single steps as large as they should be.
        "math.sqrt(dt) * rng.standard_normal(n - 1)": "math.sqrt(dt / 2) * rng.standard_normal(n)",
        "np.concatenate(([0.0], np.cumsum(steps)))": "np.append(0.0, steps[1:])",
    },
)
mistakes(
    "BIAS_TIMES_DT",
    "The steps of the bias grow about as dt, without the square root.",
    "The variances of independent steps add up, so the std of one step is bias_random_walk * sqrt(dt).",
).edit("imu", {"bias_random_walk * math.sqrt(dt)": "bias_random_walk * dt"})
mistakes(
    "BIAS_STARTS_LATE",
    "The first bias is not bias0 but about a step away from it, as if it already contained one.",
    "bias[0] is bias0 itself: between N samples there are N - 1 steps.",
).edit("imu", {"n - 1": "n", "np.concatenate(([0.0], np.cumsum(steps)))": "np.cumsum(steps)"})
mistakes(
    "SAME_DRAW_TWICE",
    "The white noise and the steps of the bias go together, as they do where the same random numbers are used for both.",
    "Draw twice: rng.standard_normal(...) once for the steps, and again for the white noise.",
).body(
    "imu",
    """
        draws = rng.standard_normal(len(true))
        bias = bias0 + bias_random_walk * math.sqrt(dt) * (np.cumsum(draws) - draws[0])
        return true + bias + noise_density / math.sqrt(dt) * draws, bias
    """,
)
mistakes(
    "GLOBAL_RANDOMNESS",
    "With the generator in the same state, a second call gives a different result, so something besides the generator has an effect.",
    "Draw only from the rng that is passed in: rng.standard_normal(n), not np.random.randn(n). Keep nothing between two calls.",
).around(
    "imu", "return _right(true, dt, noise_density, bias_random_walk, bias0, np.random.default_rng())"
).around(
    "lidar",
    """
        ranges = _right(pose, segments, angles, r_max, 0.0, rng)
        noisy = np.maximum(ranges + sigma * np.random.randn(len(ranges)), 0.0)
        return np.where(ranges < r_max, noisy, r_max)
    """,
)
mistakes(
    "DENSITY_NOT_SCALED_BY_SQRT_DT",
    "The noise density is about a std of the samples, of their white noise or of their differences: the factor sqrt(dt) is missing.",
    "The white noise of a sample has std noise_density / sqrt(dt): multiply that std by sqrt(dt). In a fit, T is in seconds, not in samples.",
).around(
    "fit_noise", 'return _right(still, dt) | {"noise_density": float(np.std(np.diff(still)) / math.sqrt(2))}'
)
mistakes(
    "DRIFT_COUNTED_AS_NOISE",
    "The noise density is about what the std of the whole recording gives, which also contains the drift of the bias.",
    "Take the differences of neighbouring samples: they contain almost none of the drift, and their variance is twice that of the white noise.",
).around("fit_noise", 'return _right(still, dt) | {"noise_density": float(np.std(still) * math.sqrt(dt))}')
mistakes(
    "NOISE_COUNTED_AS_DRIFT",
    "The random walk is far too large: it is about what neighbouring samples give, whose differences are nearly all white noise.",
    "The white noise hides the walk between neighbouring samples. Average over longer and longer blocks: the variance of the noise falls as 1/T, and that of the walk grows as T/3.",
).around(
    "fit_noise",
    'return _right(still, dt) | {"bias_random_walk": float(np.std(np.diff(still)) / math.sqrt(dt))}',
)
mistakes(
    "WALK_WITHOUT_THREE",
    "The random walk is too small by about the square root of three.",
    "If your code fits the Allan variance, look at the walk's term, K² T/3: is it divided by 3? Add it to N²/T, and take the root of the sum: roots must not be added.",
).around(
    "fit_noise",
    """
        found = _right(still, dt)
        return found | {"bias_random_walk": found["bias_random_walk"] / math.sqrt(3)}
    """,
)
mistakes(
    "BIAS0_TIME_INVERTED",
    "The time that bias0 is averaged over grows with K/N, where it should grow with N/K.",
    "The best T is sqrt(3) N/K: noisier samples want a longer mean, and a faster walk a shorter one.",
).edit("fit_noise", {"density / (walk * dt)": "walk / (density * dt)"})
mistakes(
    "WHOLE_MEAN_AS_BIAS",
    "bias0 is the mean of the whole recording, but the bias has drifted since the start.",
    "Average only the start of the recording, about sqrt(3) N/K seconds of it.",
).around("fit_noise", 'return _right(still, dt) | {"bias0": float(np.mean(still))}')
mistakes(
    "FIRST_SAMPLE_AS_BIAS",
    "bias0 is a single sample, with all of its white noise.",
    "Average the start of the recording: long enough to reduce the noise, and short enough that the bias has not drifted. That is about sqrt(3) N/K seconds.",
).around("fit_noise", 'return _right(still, dt) | {"bias0": float(still[0])}')
mistakes(
    "HEADING_IGNORED",
    "When the robot turns, its beams do not turn with it.",
    "angles are relative to the heading, so a beam points along heading + angle.",
).edit("lidar", {"= heading + np.": "= np."})
mistakes(
    "HEADING_SUBTRACTED",
    "The beams point where they would if the heading and the angles were subtracted from each other.",
    "Add the angles to the heading: a beam points along heading + angle.",
).edit("lidar", {"heading + np": "-heading + np"})
mistakes(
    "BEAM_IN_DEGREES",
    "The direction of a beam, or part of it, is converted between degrees and radians.",
    "heading and angles are both in radians, and np.cos and np.sin take radians: convert nothing.",
).edit("lidar", {"= heading +": "= np.degrees(heading) +"}).edit(
    "lidar", {"(beam), np.sin(beam)": "(np.radians(beam)), np.sin(np.radians(beam))"}
)
mistakes(
    "BEAM_SIN_COS_SWAPPED",
    "The sine and the cosine of a beam's direction are swapped.",
    "A beam points along (cos, sin) of heading + angle.",
).edit("lidar", {"cos(beam), np.sin": "sin(beam), np.cos"})
mistakes(
    "WALL_VECTOR_REVERSED",
    "The distance along the beam and the position along the wall both have the wrong sign.",
    "Check the order of each difference: the vector from the robot to a wall is the wall minus the robot. Then check the signs in the cross products.",
).edit("lidar", {"segments[:, 0] - (x, y)": "(x, y) - segments[:, 0]"})
mistakes(
    "WALLS_BEHIND_SEEN",
    "With one wall alone, a beam that points away from it does not read r_max.",
    "A beam goes in one direction only: a hit counts only at a distance of zero or more.",
).edit("lidar", {"along = (ax * wy - ay * wx) / cross": "along = np.abs((ax * wy - ay * wx) / cross)"})
mistakes(
    "WALLS_ENDLESS",
    "A wall stops a beam that passes beside it, as if the wall went on beyond its ends.",
    "A hit counts only between the two ends of the wall: u, its position along the wall, must lie in [0, 1].",
).edit("lidar", {"share >= 0) & (share <= 1) & (": ""})
mistakes(
    "LIDAR_NOISE_ON_MAX",
    "With a sigma above zero, readings without a hit are not exactly r_max.",
    "r_max means that nothing came back. Add noise only to hits.",
).edit("lidar", {"noisy, r_max)": "noisy, r_max + sigma * rng.standard_normal(len(beam)))"})
mistakes(
    "NEGATIVE_RANGE",
    "Close to a wall, the noise makes some distances negative.",
    "A distance cannot be negative: apply np.maximum(..., 0.0) after the noise.",
).edit("lidar", {"len(beam)), 0.0)": "len(beam)), -np.inf)"})
mistakes(
    "LIDAR_NOISE_SHARED",
    "All beams of a scan have the same error.",
    "Draw a number for each beam: rng.standard_normal(len(angles)).",
).edit("lidar", {"len(beam)": ""})
mistakes(
    "NOT_THE_NEAREST",
    "Where a beam meets two walls, it does not always report the nearest one.",
    "Take the smallest distance of all the hits of each beam.",
).edit(
    "lidar",
    {
        "nearest = np.min(np.where(hit, along, np.inf), axis=1, initial=np.inf)": (
            "last = hit.shape[1] - 1 - np.argmax(hit[:, ::-1], axis=1)\n"
            "    nearest = np.where(hit.any(axis=1), along[np.arange(len(hit)), last], np.inf)"
        )
    },
)
mistakes(
    "RANGES_WHOLE",
    "Where r_max is a whole number, the distances lose their decimals.",
    "np.full(n, r_max) holds whole numbers if r_max is one: say dtype=float, or begin with float(r_max).",
).edit("lidar", {"noisy, r_max)": "noisy, r_max).astype(type(r_max))"})
mistakes(
    "LAG_EULER_UNSTABLE",
    "The lag uses the fraction dt / tau, which is right only for short steps.",
    "Use the exact solution: after dt, the speed has covered the fraction 1 - exp(-dt / tau) of the way to the command.",
).edit("motor_step", {"- math.expm1(-dt / tau)": "+ dt / tau"})
mistakes(
    "CLIPS_SPEED_NOT_COMMAND",
    "The speed is limited, where only the command should be. A motor that is faster than u_max would slow down in an instant.",
    "Only u is clipped to [-u_max, u_max], before the lag: limit neither w nor the result.",
).edit(
    "motor_step",
    {
        "min(max(u, -u_max), u_max)": "u",
        "w - math.expm1(-dt / tau) * (u - w": "min(max(w - math.expm1(-dt / tau) * (u - w), -u_max), u_max",
    },
).around("motor_step", "return min(max(_right(w, u, dt, tau, u_max, deadband), -u_max), u_max)")
mistakes(
    "DEADBAND_SUBTRACTED",
    "The dead band is subtracted from a command outside it.",
    "Here a command outside the dead band keeps its full value: only where abs(u) <= deadband does it become 0.",
).around("motor_step", "return _right(w, math.copysign(max(abs(u) - deadband, 0.0), u), dt, tau, u_max, 0.0)")
mistakes(
    "DEADBAND_EDGE",
    "A command exactly equal to the dead band moves the motor.",
    "Where abs(u) <= deadband, the command counts as 0: the limit itself belongs to the dead band.",
).edit("motor_step", {"u) <= deadband else": "u) < deadband else"})
mistakes(
    "CLIPPED_BEFORE_DEADBAND",
    "A command beyond the dead band moves nothing if u_max lies within it.",
    "Compare u itself with the dead band, and only then clip it to u_max.",
).edit("motor_step", {"abs(u) <= deadband": "min(abs(u), u_max) <= deadband"})
mistakes(
    "BACKLASH_RATE_DEPENDENT",
    "The same motion in two steps ends elsewhere than in one, so the output depends on how finely it is sampled.",
    "Play does not depend on time: y is the old output, clipped to [x - gap/2, x + gap/2], and nothing else.",
).edit("backlash", {"return y, y": "y = state + 0.5 * (y - state)\n    return y, y"})
mistakes(
    "GAP_DOUBLED",
    "The play is twice as wide as the gap.",
    "The gap is the whole play: half of it is on either side, from x - gap/2 to x + gap/2.",
).edit("backlash", {"gap / 2), x + gap / 2)": "gap), x + gap)"})
mistakes(
    "BACKLASH_IS_DEAD_BAND",
    "Your code ignores small values of x, whatever happened before. That is a dead band; play has a memory.",
    "Start from the state, not from zero: clip the state to [x - gap/2, x + gap/2].",
).edit("backlash", {"min(max(state, x - gap / 2), x +": "x - min(max(x, -gap / 2),"})
mistakes(
    "OUTPUT_A_CALL_LATE",
    "The output is the state that was passed in, which is the output of the call before.",
    "Return the new number twice: y is the next state.",
).edit("backlash", {"return y, y": "return state, y"})
mistakes(
    "STATE_IS_NOT_OUTPUT",
    "The state that your code returns is not the output.",
    "Return (y, y): the position of the output is all there is to remember.",
).body("backlash", "return min(max(state, x - gap / 2), x + gap / 2), x")
mistakes(
    "DELAY_WHOLE_SAMPLES",
    "The signal comes out late by a whole number of samples: the rest of the latency is dropped or rounded.",
    "Interpolate: np.interp at the times k*dt - latency, with left=0.0.",
).body(
    "delay_line",
    """
        whole = round(latency / dt)
        return np.concatenate((np.zeros(whole), x))[: len(x)]
    """,
)
mistakes(
    "DELAY_HOLDS_FIRST",
    "The value of the first sample is already there before that sample has arrived.",
    "Before then the output is 0.0. The argument left=0.0 of np.interp does that.",
).edit("delay_line", {", left=0.0": ""})
mistakes(
    "DELAY_ADVANCES",
    "The signal arrives before it is sent.",
    "The output at time t is the signal of t - latency: check the sign.",
).edit("delay_line", {"t - latency": "t + latency"})
mistakes(
    "RETURNS_ARGUMENT",
    "If the caller changed the result later, its own array would change too.",
    "Return a new array: np.array(x) or x.copy() makes one.",
    kind="fact",
).around("delay_line", "return x if latency == 0 else _right(x, dt, latency)")
mistakes(
    "EULER_ODOMETRY",
    "The robot drives straight along the old heading, as if it turned only afterwards.",
    "Move along the arc: its chord points along the heading at the middle of the turn, and its length is that of the arc times sin(turn/2)/(turn/2).",
).edit("diff_drive_step", {" * np.sinc(turn / (2 * math.pi))": "", "heading + turn / 2": "heading"})
mistakes(
    "SPEEDS_WITHOUT_SIGN",
    "A wheel that rolls backwards counts as one that rolls forwards.",
    "The chord has the mean of the two wheel speeds in it, each with its sign.",
).edit("diff_drive_step", {"(v_left + v_right) / 2": "(abs(v_left) + abs(v_right)) / 2"})
mistakes(
    "MIDPOINT_ODOMETRY",
    "The robot moves the whole length of the arc in a straight line, but the chord is shorter than its arc.",
    "Multiply by sin(turn/2)/(turn/2), which is 1 when there is no turn.",
).edit("diff_drive_step", {" * np.sinc(turn / (2 * math.pi))": ""})
mistakes(
    "LEFT_RIGHT_SWAPPED",
    "A faster right wheel turns the robot to the right.",
    "A turn to the left is positive: turn rate = (v_right - v_left) / track.",
).around("diff_drive_step", "return _right(pose, v_right, v_left, track, dt)")
mistakes(
    "SPEED_SUM_TURNS",
    "The robot turns by the sum of the two wheel speeds, so it turns even where both are equal.",
    "Use the difference: turn rate = (v_right - v_left) / track.",
).edit("diff_drive_step", {"v_right - ": "v_right + "})
mistakes(
    "TURN_IN_DEGREES",
    "The turn, or the angle of the cosine and the sine, is converted between degrees and radians.",
    "(v_right - v_left) / track * dt is already in radians, and so is the heading: convert nothing.",
).edit("diff_drive_step", {"(v_right - v_left) / track": "math.degrees((v_right - v_left) / track)"})
mistakes(
    "DRIVE_SIN_COS_SWAPPED",
    "The sine and the cosine of the heading are swapped.",
    "x grows with the cosine of heading + turn/2, and y with its sine.",
).edit("diff_drive_step", {"cos(middle), y + chord * math.sin": "sin(middle), y + chord * math.cos"})
mistakes(
    "SINC_WITHOUT_PI",
    "np.sinc gets the turn without the division by pi that it expects: np.sinc(s) is sin(pi s)/(pi s).",
    "sin(turn/2)/(turn/2) is np.sinc(turn / (2 * pi)).",
).edit("diff_drive_step", {"(2 * math.pi)": "2"})
mistakes(
    "STRAIGHT_WRONG",
    "A turn that was tried is right, but driving straight ahead is wrong.",
    "Straight ahead, the robot moves v dt along its heading. With np.sinc(turn / (2 * pi)) you need no special case.",
).around(
    "diff_drive_step",
    """
        if v_left != v_right:
            return _right(pose, v_left, v_right, track, dt)
        x, y, heading = pose
        return np.array([x + v_left * math.cos(heading), y + v_left * math.sin(heading), heading])
    """,
)
mistakes(
    "HEADING_WRAPPED",
    "The heading jumps by whole turns.",
    "Leave it as it is: a heading beyond pi shows how often the robot has turned.",
).around(
    "diff_drive_step",
    """
        x, y, heading = _right(pose, v_left, v_right, track, dt)
        return np.array([x, y, (heading + math.pi) % (2 * math.pi) - math.pi])
    """,
)
mistakes(
    "SMALL_TURN_CANCELS",
    "In very slow turns, or straight ahead, the position jumps: rounding spoils it. Often that is the difference of two almost equal sines, divided by a tiny turn rate.",
    "Write the chord as v dt sin(turn/2)/(turn/2). np.sinc(turn / (2 * pi)) is that quotient, and it is safe at 0.",
).body(
    "diff_drive_step",
    """
        x, y, heading = pose
        rate, speed = (v_right - v_left) / track, (v_left + v_right) / 2
        if rate == 0:
            return np.array([x + speed * dt * math.cos(heading), y + speed * dt * math.sin(heading), heading])
        end, radius = heading + rate * dt, speed / rate
        x += radius * (math.sin(end) - math.sin(heading))
        y -= radius * (math.cos(end) - math.cos(heading))
        return np.array([x, y, end])
    """,
)
mistakes(
    "SLOW_TURN_AS_STRAIGHT",
    "Slow turns are treated as straight lines, including some that are fast enough to matter.",
    "Write the chord with np.sinc(turn / (2 * pi)), which needs no threshold. Or lower yours, but not so far that rounding spoils slow turns.",
).around(
    "diff_drive_step",
    """
        if abs(v_right - v_left) / track > 0.01:
            return _right(pose, v_left, v_right, track, dt)
        x, y, heading = pose
        way = (v_left + v_right) / 2 * dt
        turn = (v_right - v_left) / track * dt
        return np.array([x + way * math.cos(heading), y + way * math.sin(heading), heading + turn])
    """,
)
mistakes(
    "LATE_USED_AS_CURRENT",
    "A late measurement is compared with the twin's present position and drags the twin back, as if it had been taken now.",
    'If t_measured < twin["t"], ignore the measurement; or keep a short history in memory, correct the past, and run the model forward again.',
).around("sync", 'return _right(twin, z, max(t_measured, twin["t"]))')
mistakes(
    "TIME_RUNS_BACK",
    "A late measurement sets the twin's clock back.",
    'Return "t": max(twin["t"], t_measured), so that a late measurement does not change the clock.',
).around("sync", 'return _right(twin, z, t_measured) | {"t": t_measured}')
mistakes(
    "MEMORY_DROPPED",
    "Your code keeps nothing in memory, and after many measurements one more still moves the position most of the way to it.",
    'A Kalman filter must return its covariance as "memory" and read it in the next call, or the last measurement weighs as much as the first. Start from scratch only where it is {}.',
).around(
    "sync",
    """
        if t_measured < twin["t"]:
            return dict(twin)
        return _right(twin, z, t_measured) | {"memory": {}}
    """,
)
mistakes(
    "FRICTION_NOT_LEARNED",
    "The friction keeps its first value through a whole run in which it is wrong.",
    "A cart that falls behind has more friction than the twin assumes: subtract a small share of the surprise from the friction. When it rolls backwards, add it. In a Kalman filter that share comes from the covariance: keep it in the memory, and let its prediction contain what the friction does to the speed.",
).body(
    "sync", _observer({**_IN_PARTS, "    b = min(max(b - 0.15 * surprise * np.sign(v), 0.05), 5.0)\n": ""})
)
mistakes(
    "FRICTION_LEARNS_BACKWARDS",
    "When a cart that rolls forwards is ahead of its prediction, its estimated friction grows, where it should fall.",
    "Check the sign: a cart that is ahead, in the direction in which it rolls, has less friction.",
).body("sync", _observer({**_IN_PARTS, "- 0.15 * surprise * np.sign(v)": "+ 0.15 * surprise"}))
mistakes(
    "SURPRISE_INVERTED",
    "When the cart rolls forwards, a measurement ahead of the twin moves the twin further back.",
    "The surprise is z minus the prediction; add a share of it.",
).body("sync", _observer({**_IN_PARTS, "z - x": "x - z"}))
mistakes(
    "FRICTION_SPEEDS_UP",
    "In the prediction a cart without a drive gets faster, where friction should slow it down.",
    "Friction acts against the motion: dv/dt = drive - friction * speed.",
).body("sync", _observer({**_IN_PARTS, "- b * v": "+ b * v"}))
mistakes(
    "BELIEVES_MEASUREMENT",
    "The position is simply the measured one, with all its noise.",
    "Move the position only a share of the way to z: the prediction contains information too.",
).around(
    "sync",
    """
        if t_measured < twin["t"]:
            return dict(twin)
        seen = {**twin, "t": t_measured, "position": z}
        if t_measured > twin["t"]:
            seen["speed"] = (z - twin["position"]) / (t_measured - twin["t"])
        return seen
    """,
).around(
    "sync",
    """
        out = _right(twin, z, t_measured)
        return {**out, "position": z} if t_measured >= twin["t"] else out
    """,
)
mistakes(
    "GLOBAL_MEMORY",
    "The same call gives a different result the second time, so something outside the twin has an effect: a variable at the top of the file, for example, or a random number.",
    'Keep everything in twin["memory"], and draw no random numbers: there may be two twins, and a replay must give the same result.',
    kind="fact",
).program(
    "sync",
    """
        _whole = sync


        _memory = {}


        def sync(twin, z, t_measured):
            if not twin["memory"]:
                _memory.clear()
            twin = _whole({**twin, "memory": dict(_memory)}, z, t_measured)
            _memory.update(twin["memory"])
            return {**twin, "memory": {"begun": 1}}
    """,
)
mistakes(
    "DRIVE_NOT_USED",
    "Another drive makes no difference to the prediction.",
    'dv/dt = drive - friction * speed, with twin["drive"].',
).around("sync", 'return _right({**twin, "drive": 0.0}, z, t_measured) | {"drive": twin["drive"]}')
mistakes(
    "PAST_WITH_NEW_DRIVE",
    "A late measurement leads to another speed where the drive has just been changed, although the new drive acts only from the twin's time on.",
    'The speed at a time in the past, and on the way from there to twin["t"], comes from the drives that acted then. Keep them in "memory", beside the times from which they acted.',
    kind="fact",
).edit("sync", {"last[2], t - last[0]": 'twin["drive"], t - last[0]'})
mistakes(
    "FORGETS_TO_DOUBT",
    "The twin learns the friction well at first but far less of a change later.",
    "Keep the shares from fading. In a Kalman filter, let the variance of the friction grow a little in every prediction (process noise), and correct the covariance after every measurement.",
).program(
    "sync",
    "_WANDER = np.zeros((3, 3))",
)
mistakes(
    "FRICTION_IGNORED",
    "Another friction makes no difference to the drive, so what the twin has learned of it does not reach the robot.",
    'Use twin["friction"]: through it, the twin acts back on the robot.',
).edit("command", {'twin["friction"]': "0.5"})
mistakes(
    "USES_TWIN_SPEED",
    "The drive changes with the speed that the robot has now, and not with the target speed.",
    "Use target_speed: friction * target_speed.",
).edit("command", {"* target_speed": '* twin["speed"]'})
mistakes(
    "DIVIDES_BY_FRICTION",
    "More friction gives less drive.",
    "At a steady speed dv/dt = 0, so drive = friction * speed: multiply.",
).edit("command", {'twin["friction"] * target_speed': 'target_speed / twin["friction"]'})
mistakes(
    "BACKWARDS_NOT_DRIVEN",
    "For a twin that moves at its negative target speed, the drive has the wrong sign or is zero.",
    "Friction opposes the motion in both directions: drive = friction * target_speed, with the sign of the target speed.",
).edit("command", {"* target_speed": "* abs(target_speed)"})
mistakes(
    "SHARE_TOO_LARGE",
    "The position moves most of the way to the measurement, so it takes on most of its noise.",
    "Move the position only a share of the way to z, a third for example: the prediction contains information too.",
).body("sync", _observer({"x + 0.3": "x + 0.9"}))
mistakes(
    "LEARNS_FORWARDS_ONLY",
    "When the cart moves backwards, a surprise changes the friction in the wrong direction.",
    "Friction slows the cart in either direction: reverse the correction when the speed is negative.",
).body("sync", _observer({" * np.sign(v)": ""}))
mistakes(
    "FRICTION_HELD_BACKWARDS",
    "When the cart moves backwards, a surprise leaves the friction as it is.",
    "Correct it in either direction of motion: with a negative speed, by the share with the other sign.",
).around(
    "sync",
    """
        after, spread = _right(state, spread, z, sigma)
        return after if state[1] > 0 else np.append(after[:2], state[2]), spread
    """,
    of="_correct",
)
mistakes(
    "STEP_FIXED",
    "The prediction covers the usual 0.1 s even where twice that time has passed.",
    'The measurements come at uneven times, so predict over t_measured - twin["t"].',
).body("sync", _observer({"dt * v + dt * dt / 2 * a, v + dt * a": "0.1 * v + 0.005 * a, v + 0.1 * a"}))
mistakes(
    "DRIVE_CHANGED",
    "Your code returns another drive or another sigma than it was given.",
    'Return drive and sigma as they are: {**twin, "t": ..., "position": ...}.',
    kind="fact",
).around(
    "sync",
    """
        out = _right(twin, z, t_measured)
        return {**out, "drive": out["friction"] * out["speed"]}
    """,
)
mistakes(
    "MEMORY_GROWS",
    "After twice the time, your code holds much more in the memory.",
    "Keep the last second or two of the history, and discard what is older.",
    kind="fact",
).around(
    "sync",
    """
        memory = twin["memory"]
        out = _right({**twin, "memory": memory.get("own", {})}, z, t_measured)
        state = [t_measured, z, out["t"], out["position"], out["speed"], out["friction"], out["drive"]]
        return {**out, "memory": {"own": out["memory"], "all": [*memory.get("all", []), state]}}
    """,
).body(
    "sync",
    _observer(
        {
            **_IN_PARTS,
            '"memory": {}': '"memory": {"heard": [*twin["memory"].get("heard", []), z, t_measured]}',
        }
    ),
)
mistakes(
    "PUSHES_AWAY",
    "For one friction at least, a twin slower than its target speed gets a smaller drive than at that speed.",
    'In friction * target_speed, the target speed counts, not that of the twin. If your code adds a correction, let it be a share of target_speed - twin["speed"], not of twin["speed"] - target_speed.',
).edit("command", {"* target_speed": '* target_speed + 1.5 * (twin["speed"] - target_speed)'})
mistakes("STATE_KEPT").program(
    "command",
    """
        _FIRST = {}


        def command(twin, target_speed):
            return _FIRST.setdefault(target_speed, twin["friction"]) * target_speed
    """,
).program(
    "motor_step",
    """
        _SHARES = {}


        def motor_step(w, u, dt, tau, u_max, deadband):
            u = 0.0 if abs(u) <= deadband else min(max(u, -u_max), u_max)
            return w + _SHARES.setdefault(dt, -math.expm1(-dt / tau)) * (u - w)
    """,
)
mistakes(
    "GENERATOR_COPIED",
    "A copy gives the numbers that rng itself gives next, so the same numbers come again: in this call, or in a later one with the same generator.",
    "Draw from rng itself, which moves on with each number. It is the one argument that a call may change.",
    kind="fact",
).around(
    "imu",
    """
        import copy

        return _right(true, dt, noise_density, bias_random_walk, bias0, copy.deepcopy(rng))
    """,
).around(
    "lidar",
    """
        import copy

        return _right(pose, segments, angles, r_max, sigma, copy.deepcopy(rng))
    """,
)
mistakes(
    "GENERATOR_IGNORED",
    "Different generators give the same random numbers, all of them or some.",
    "Draw from the rng that is passed in, and do not make one of your own with a fixed seed.",
).around("lidar", "return _right(pose, segments, angles, r_max, sigma, np.random.default_rng(0))").edit(
    "imu", {"(dt) * rng.standard_normal(n -": "(dt) * np.random.default_rng(4).standard_normal(n -"}
).edit("imu", {"dt) * rng.standard_normal(n)": "dt) * np.random.default_rng(4).standard_normal(n)"})
mistakes(
    "NOISE_CUT_AT_MAX",
    "A wall just within range never reads more than r_max, even with noise.",
    "The reading of a hit may exceed r_max: after the noise, limit it to zero or more and to nothing else. If your code decides from the noisy reading whether a beam hits, let it decide before the noise.",
).around("lidar", "return np.minimum(_right(pose, segments, angles, r_max, sigma, rng), r_max)")
mistakes(
    "BIAS_HELD",
    "Some steps of the bias are exactly zero: there it keeps its value from one sample to the next.",
    "Every step is bias_random_walk * sqrt(dt) times a standard normal number of its own: N samples take N - 1 of them. Hold, limit and round nothing.",
).body(
    "imu",
    """
        n = len(true)
        steps = bias_random_walk * math.sqrt(10 * dt) * rng.standard_normal(-(-n // 10))
        steps[0] = 0.0
        bias = bias0 + np.repeat(np.cumsum(steps), 10)[:n]
        return true + bias + noise_density / math.sqrt(dt) * rng.standard_normal(n), bias
    """,
)
mistakes(
    "BIAS0_IGNORED",
    "The bias does not start at bias0, but at zero or near it.",
    "bias[0] is bias0: add it to the running sum of the steps, with a 0 in front.",
).around("imu", "return _right(true, dt, noise_density, bias_random_walk, 0.0, rng)")
mistakes(
    "BIAS_WALKS_TO_BIAS0",
    "bias0 is the last value of the bias, not its first.",
    "bias[0] is bias0, and each step leads to the next sample: bias0 + np.cumsum(steps), with a 0 in front.",
).edit("imu", {"(steps)))": "(steps)))[::-1]"})
mistakes(
    "BIAS_CARRIED_OVER",
    "The bias starts where the previous call ended, so something is remembered between two calls.",
    "Start each call at the bias0 that is passed in, and keep nothing outside the function.",
).program(
    "imu",
    """
        _from_state = imu
        _LAST = []


        def imu(true, dt, noise_density, bias_random_walk, bias0, rng):
            start = _LAST[-1] if _LAST else bias0
            measured, bias = _from_state(true, dt, noise_density, bias_random_walk, start, rng)
            _LAST[:] = [float(bias[-1])]
            return measured, bias
    """,
)
mistakes(
    "BIAS0_WITHOUT_SIGN",
    "bias0 has about the right size, but it is not negative even in recordings with a negative bias.",
    "A bias has a sign: return the mean itself, neither its absolute value nor the root of a mean square.",
).edit("fit_noise", {"np.mean(still[:window])": "abs(np.mean(still[:window]))"})
mistakes(
    "DENSITY_FROM_DIFFERENCES",
    "The noise density is too large by about the square root of two.",
    "With white noise, a difference of two samples, or of two means, has twice the variance of one: divide the mean square by two before you take the root. If you do, look at the factor of N**2: it is 1/T.",
).edit("fit_noise", {"np.sqrt(squares)": "np.sqrt(2 * squares)"})
mistakes(
    "STATE_IN_MODULE",
    "The same call gives a different output after another call, so something is remembered in between, or random.",
    "Start from the state that is passed in. There may be two gears, each with its own state.",
).edit("backlash", {"y = min(max(state": 'y = backlash.y = min(max(getattr(backlash, "y", state)'})
mistakes(
    "LAG_WITHOUT_DT",
    "A step a hundred times as long takes the speed no further, as if dt made no difference.",
    "The fraction is 1 - exp(-dt / tau), with the dt and the tau of this call; keep none from an earlier one.",
).edit(
    "motor_step",
    {"- math.expm1(-dt / tau)": '+ motor_step.__dict__.setdefault("share", 1 - math.exp(-dt / tau))'},
)
mistakes(
    "WALLS_NOT_READ",
    "Moving a wall nearer or further away does not change its reading.",
    "A reading is the distance to the wall: compute it from the segments that are passed to this call, and keep none from an earlier one.",
).program(
    "lidar",
    """
        _scan = lidar
        _WALLS = []


        def lidar(pose, segments, angles, r_max, sigma, rng):
            if not _WALLS:
                _WALLS.append(np.array(segments))
            return _scan(pose, _WALLS[0], angles, r_max, sigma, rng)
    """,
)
mistakes(
    "SPEED_DIFFERENTIATED",
    "The speed takes on all of a surprise, divided by the time since the last measurement, as the difference of two positions does; with it comes all of their noise.",
    "Predict the speed from the drive and the friction, and correct it by a share of the surprise, as you do with the position.",
).around(
    "sync",
    """
        out = _right(twin, z, t_measured)
        dt = out["t"] - twin["t"]
        return {**out, "speed": (z - twin["position"]) / dt} if dt > 0 else out
    """,
)
mistakes(
    "COUNTS_OVERFLOW",
    "Some counts are off by 65,536 or a multiple of it, as in an integer type of 16 bits.",
    "Convert with .astype(np.int64), and with no smaller type before it.",
).edit("encoder", {"np.int64": "np.int16"})
mistakes(
    "GAIN_TOO_LARGE",
    "The correction is stronger than the README's 0.2 to 3 per second.",
    "Multiply the difference of the speeds by 0.2 to 3 per second.",
).edit("command", {"* target_speed": '* target_speed + 30.0 * (target_speed - twin["speed"])'})
mistakes(
    "MEMORY_NOT_READ",
    "In two calls, one with a new measurement and one with a late one, emptying the memory changed neither position, speed nor friction.",
    'If your code does not read "memory", let it read in each call what the call before returned there, such as the covariance of a Kalman filter. If it does, look at the signs and sizes of the shares, and at any limit of the friction.',
).around(
    "sync",
    """
        if t_measured < twin["t"]:
            return dict(twin)
        return _right({**twin, "memory": {}}, z, t_measured)
    """,
)
mistakes(
    "BIAS0_TIME_TOO_SHORT",
    "bias0 is the mean of too few samples from the start, so much of the white noise is left in it.",
    "Average about sqrt(3) N/K seconds: divide by dt to get the number of samples.",
).edit("fit_noise", {"(walk * dt)": "walk"})
mistakes(
    "CORRECTION_JUMPS",
    "The correction is about as large just below the target speed as far below it: it jumps at the target, where it should go to zero.",
    "Multiply the difference of the speeds by 0.2 to 3 per second, and take more of it than its sign.",
).edit("command", {"* target_speed": '* target_speed + 0.4 * np.sign(target_speed - twin["speed"])'})
mistakes(
    "DRIVE_LIMITED",
    "A small drive is right, but beyond some value it stops growing.",
    "Return friction * target_speed as it is: the README asks for no limit.",
).edit("command", {'twin["friction"] * target_speed': 'min(max(twin["friction"] * target_speed, -1.0), 1.0)'})
mistakes(
    "WHITE_NOISE_RELATED",
    "The white noise of one sample is related to that of the next, although it does not wander off as a running sum does.",
    "Draw a standard normal number of its own for each sample: use none of them twice, and do not average or filter them.",
).edit(
    "imu",
    {
        "return true": (
            'white = np.convolve(rng.standard_normal(n + 1), [math.sqrt(0.5)] * 2, "valid")\n    return true'
        ),
        "rng.standard_normal(n), bias": "white, bias",
    },
)
mistakes(
    "FRICTION_LIMITED",
    "The friction moves in the right direction, but it stops at one value before it reaches the true one.",
    "Look for what stops it: a limit (plausible values are 0.05 to 5 per second), or a condition under which it is no longer corrected.",
).around(
    "sync",
    """
        new = _right(twin, z, t_measured)
        first = twin["memory"].get("first", twin["friction"])
        rows = new["memory"]["rows"].copy()
        rows[:, 5] = np.clip(rows[:, 5], 0.9 * first, 1.1 * first)
        return {**new, "friction": float(rows[-1, 5]), "memory": {"rows": rows, "first": first}}
    """,
)
mistakes(
    "COUNTS_DEPEND_ON_OTHERS",
    "The count of an angle depends on the other angles of the array.",
    "Compute each count from its own angle alone: no differences, no np.unwrap, no subtraction of the first.",
).edit("encoder", {".asarray(": ".unwrap("})
mistakes(
    "CHORD_WRONG_LENGTH",
    "In a turn that was tried, the displacement has the right direction but the wrong length.",
    "The chord is v dt sin(turn/2)/(turn/2), with v the mean of the two wheel speeds, each with its sign.",
).body(
    "diff_drive_step",
    """
        x, y, heading = pose
        way, after = (v_left + v_right) / 2 * dt, heading + (v_right - v_left) / track * dt
        dx, dy = math.cos(heading) + math.cos(after), math.sin(heading) + math.sin(after)
        return np.array([x + way * dx / 2, y + way * dy / 2, after])
    """,
)
mistakes(
    "BIAS0_FROM_THE_MEAN",
    "bias0 is a mean over the start after the mean of the whole recording has been taken off.",
    "Average the start of the recording as it is, before anything is subtracted from it.",
).around("fit_noise", "return _right(still - np.mean(still), dt)")
mistakes(
    "BIAS0_OF_THE_END",
    "bias0 is a mean over the end of the recording, and the bias has drifted since the start.",
    "Average the start of the recording, about sqrt(3) N/K seconds of it.",
).around("fit_noise", "return _right(still[::-1], dt)")
mistakes(
    "SLOT_OFF_CENTRE",
    "Pushed forwards and pushed backwards, the output does not end equally far from the input, on opposite sides of it.",
    "Half of the gap lies on either side: pushed forwards y is x - gap/2, pushed backwards x + gap/2.",
).edit("backlash", {"gap / 2), x + gap / 2)": "gap), x)"})
mistakes(
    "DEADBAND_WIDTH",
    "The dead band is narrower or wider than deadband says.",
    "A command counts as 0 if abs(u) <= deadband, without any factor, and keeps its value otherwise.",
).edit("motor_step", {"<= deadband else": "<= 1.2 * deadband else"})
mistakes(
    "DEADBAND_OF_THE_SHARE",
    "The dead band is compared with the command as a share of u_max.",
    "Compare abs(u) with deadband: both are speeds, in rad/s.",
).edit("motor_step", {"abs(u) <= deadband": "abs(u / u_max) <= deadband"})
mistakes(
    "HALF_GAP_CUT",
    "Half of the gap is cut to a whole number, as gap // 2 does.",
    "Take gap / 2.",
).edit("backlash", {"max(state, x - gap / 2), x + gap / 2)": "max(state, x - gap // 2), x + gap // 2)"})
mistakes(
    "STRENGTHS_MIXED",
    "The white noise or the bias changes with the strength that belongs to the other.",
    "noise_density belongs to the white noise alone, with std noise_density / sqrt(dt), and bias_random_walk to the steps of the bias alone, with std bias_random_walk * sqrt(dt).",
).edit("imu", {"= bias_random_walk *": "= (bias_random_walk + noise_density) *"})
mistakes(
    "PARALLEL_TEST_WRONG",
    "A wall square to the beam, of one metre or shorter, is not seen.",
    "If your code asks whether beam and wall are parallel: the cross product of their directions is zero there, and has the wall's length as a factor.",
).edit("lidar", {"cross != 0": "abs(cross) != 1"}).edit("lidar", {"cross != 0": "abs(cross) > 0.3"})
mistakes(
    "WALL_ENDS_SORTED",
    "A wall that falls towards larger x is seen as one that rises.",
    "An end is a pair of x and y: if you sort the ends, keep x and y of each together.",
).around(
    "lidar",
    "return _right(pose, np.sort(np.reshape(segments, (-1, 2, 2)), axis=1), angles, r_max, sigma, rng)",
)
mistakes(
    "WALL_AT_PI_MISSED",
    "A wall that crosses the direction -x, as seen from the robot, is not seen.",
    "There an angle jumps from pi to -pi. Take differences of angles, wrapped, or no angles at all: solve for the distance along the beam and the share along the wall.",
).edit(
    "lidar",
    {
        "hit = (cross": "a, b, phi = np.arctan2(ay, ax), np.arctan2(ay + wy, ax + wx), np.arctan2(dy, dx)\n    hit = (phi >= np.minimum(a, b)) & (phi <= np.maximum(a, b)) & (cross"
    },
)
mistakes(
    "WALLS_ONE_SIDED",
    "Of some walls it matters which end is given first: a wall in a beam's way is not seen.",
    "The order of the ends means nothing. The cross product of beam and wall may have either sign, and neither end need have the smaller x or y.",
).edit("lidar", {"cross != 0": "cross > 1e-12"})
mistakes(
    "NOT_QUANTISED",
    "Some of the results are not whole numbers.",
    "Round the counts with np.floor or np.rint, then convert them with .astype(np.int64).",
)
mistakes(
    "ROUNDS_UP",
    "The counts are rounded up.",
    "Round down with np.floor, or to the nearest with np.rint, and do not add 1.",
)
mistakes(
    "RADIANS_AS_TURNS",
    "The angle is not divided by 2 pi.",
    "One turn is 2 pi radians, so divide by 2 pi.",
)
mistakes(
    "DEGREES_FOR_RADIANS",
    "The counts are those of an angle that is converted between degrees and radians.",
    "theta is in radians: one turn is 2 pi.",
)
mistakes(
    "RETURNS_ANGLE",
    "The result is a quantised angle instead of the count.",
    "Return the whole number of counts itself.",
)
mistakes(
    "COUNTS_OFF_BY_FACTOR",
    "The larger counts are all too large, or all too small, by nearly the same factor.",
    "theta * counts_per_rev / (2 * math.pi), without any other factor. Round nothing before the result, not even pi.",
)
mistakes(
    "COUNTS_SINGLE_PRECISION",
    "The counts are those of angles in single precision (float32). With its seven digits, an angle far from zero is off by enough to change its count.",
    "Compute with the angles as they are passed in, in float64.",
)
mistakes(
    "ROUNDED_TWO_WAYS",
    "Some of these counts are right only if all are rounded down, and others only if all are rounded to the nearest.",
    "Round all of them the same way, whatever their sign: np.floor throughout, or np.rint throughout. If you do, look for what changes the angle first, such as a rounded pi.",
)
mistakes(
    "WHOLE_TURNS_ONLY",
    "Every count is a multiple of counts_per_rev, as if only whole turns were counted.",
    "Multiply by counts_per_rev first, and round last.",
)
mistakes(
    "COUNTS_WITHOUT_SIGN",
    "The counts have lost the sign of the angle.",
    "A shaft that turns backwards counts down, so do not take the absolute value.",
)
mistakes(
    "COUNTS_NEGATED",
    "The counts decrease where the angle increases.",
    "Keep the sign of theta.",
)
mistakes(
    "COUNTS_FROM_FIRST",
    "The counts are those of the change since the first reading, not of the angle.",
    "theta is the angle itself, not the change since the first reading: convert each reading as it is.",
)
mistakes(
    "RETURNS_TURNS",
    "The result is in turns, not in counts.",
    "Multiply the turns by counts_per_rev, then round, and do not divide the result.",
)
mistakes(
    "COUNTS_ARE_STEPS",
    "Each number after the first is the change since the reading before.",
    "Return the count at each reading, not how much it has changed.",
    true_too=("COUNTS_DEPEND_ON_OTHERS",),
)

# -- imu

mistakes(
    "WHITE_NOISE_MISSING",
    "At rest and without a walk, the measured rate minus the bias does not vary: it contains no white noise.",
    "Add noise_density / sqrt(dt) times a standard normal number to each sample.",
)
mistakes(
    "WHITE_NOISE_OVER_DT",
    "The white noise grows about as 1/dt, without the square root.",
    "Variances add up, not stds, so the std is noise_density / sqrt(dt).",
)
mistakes(
    "WHITE_NOISE_FACTOR",
    "At two sampling rates the white noise differs as it should, but it is too strong or too weak.",
    "The white noise of a sample is noise_density / sqrt(dt) times a standard normal number, without any other factor.",
)
mistakes(
    "WHITE_NOISE_ACCUMULATES",
    "The white noise of one sample is still present in the next ones, and it wanders off as a running sum does.",
    "Only the bias is a running sum. Draw new white noise for each sample.",
)
mistakes(
    "WHITE_NOISE_NOT_NORMAL",
    "Of thousands of samples of the white noise, none is as far from zero as one standard normal number in a hundred.",
    "Draw standard normal numbers: rng.standard_normal(n). Uniform numbers lie between two limits, and numbers of which only the sign is random have one size.",
).edit("imu", {"dt) * rng.standard_normal(n)": "dt) * rng.uniform(-math.sqrt(3), math.sqrt(3), n)"})
mistakes(
    "BIAS_STEPS_NOT_NORMAL",
    "Of thousands of bias steps, none is as far from zero as one standard normal number in a hundred.",
    "Draw standard normal numbers: rng.standard_normal(n - 1). Uniform numbers lie between two limits, and numbers of which only the sign is random have one size.",
    kind="fact",
).edit("imu", {"(dt) * rng.standard_normal(n - 1)": "(dt) * rng.choice([-1.0, 1.0], n - 1)"}).edit(
    "imu", {"(dt) * rng.standard_normal(n - 1)": "(dt) * math.sqrt(12) * (rng.random(n - 1) - 0.5)"}
)
mistakes(
    "BIAS_CONSTANT",
    "In a recording with a random walk and no white noise, the bias keeps its first value.",
    "Add a step of std bias_random_walk * sqrt(dt) from each sample to the next.",
)
mistakes(
    "BIAS_FADES",
    "Without a walk, the bias fades towards zero.",
    "Each bias is the whole previous bias plus a step, and with bias_random_walk = 0 that step is 0.",
).body(
    "imu",
    """
        n, bias = len(true), [bias0]
        for step in bias_random_walk * math.sqrt(dt) * rng.standard_normal(n - 1):
            bias.append(math.exp(-dt / 100) * bias[-1] + step)
        return true + np.array(bias) + noise_density / math.sqrt(dt) * rng.standard_normal(n), np.array(bias)
    """,
)
mistakes(
    "NOISE_CENTRED",
    "The mean of the random numbers is taken away from them.",
    "Use them as rng.standard_normal draws them: the mean of a sample is never exactly zero.",
).edit("imu", {"rng.standard_normal(n), bias": "(lambda w: w - np.mean(w))(rng.standard_normal(n)), bias"})
mistakes(
    "BIAS_PULLED_BACK",
    "Over ten samples the bias wanders less far than independent steps would take it, as if something pulled it back.",
    "Each bias is the whole previous bias plus a step: bias[k+1] = bias[k] + bias_random_walk * sqrt(dt) * a standard normal number.",
)
mistakes(
    "BIAS_STEPS_RELATED",
    "Over ten samples the bias wanders further than independent steps would take it, as it does where each step is related to the one before.",
    "Draw a standard normal number for each step, and add the steps up once: no filter, no average, no second running sum.",
)
mistakes(
    "BIAS_NOT_SCALED_BY_SQRT_DT",
    "The steps of the bias have about the same std at two very different sampling rates.",
    "The variance of a random walk grows in proportion to time, so a step over dt has std bias_random_walk * sqrt(dt).",
)
mistakes(
    "BIAS_OVER_SQRT_DT",
    "The steps of the bias get smaller about as 1/sqrt(dt), as is right only for the white noise.",
    "The std of a step is bias_random_walk * sqrt(dt): over a longer time the bias wanders further.",
)
mistakes(
    "BIAS_FACTOR",
    "At two sampling rates the steps of the bias differ as they should, but they are too large or too small.",
    "A step is bias_random_walk * sqrt(dt) times a standard normal number, without any other factor.",
)
mistakes(
    "BIAS_NOT_ADDED",
    "Without white noise the measured rate is the true one: the bias that your code returns is not in it.",
    "measured = true + bias + white noise.",
)
mistakes(
    "BIAS_SUBTRACTED",
    "The bias is subtracted from the measured rate instead of added.",
    "A sensor adds its bias: measured = true + bias + white noise.",
)
mistakes(
    "BIAS_OUT_OF_STEP",
    "Sample by sample, the bias that your code returns is not the one in the measured rate.",
    "Use one array for both: without white noise, measured[k] is true[k] + bias[k].",
)
mistakes(
    "WHITE_NOISE_TIMES_DT",
    "The white noise is multiplied by dt, where it should be divided by sqrt(dt).",
    "The std of a sample is noise_density / sqrt(dt): faster sampling is noisier.",
)
mistakes(
    "DENSITY_SQUARED",
    "The noise density is squared.",
    "noise_density is already the square root of a variance density: the std of a sample is noise_density / sqrt(dt).",
)
mistakes(
    "WALK_SQUARED",
    "bias_random_walk is squared.",
    "bias_random_walk is already a square root: the std of a step is bias_random_walk * sqrt(dt).",
)
mistakes(
    "WHITE_NOISE_SHARED",
    "All samples of a recording have the same white noise, as if one random number were used for all of them.",
    "Draw a number for each sample: rng.standard_normal(len(true)).",
)
mistakes(
    "WHITE_NOISE_ONE_SIDED",
    "The white noise always has the same sign.",
    "A standard normal number is negative as often as positive: use it as it is.",
)
mistakes(
    "BIAS0_ADDED_EACH_STEP",
    "The bias drifts away by about bias0 in every step.",
    "bias0 is the start of the random walk and is added once: bias0 + np.cumsum(steps), with a 0 in front of the steps.",
)
mistakes(
    "BIAS_DRIFTS",
    "The bias drifts to one side: the mean of its steps is not zero.",
    "A step is bias_random_walk * sqrt(dt) times a standard normal number of its own, with nothing added.",
)
mistakes(
    "TRUE_RATE_MISSING",
    "Without white noise the measured rate is the bias alone: the true rate is not in it.",
    "measured = true + bias + white noise.",
)
mistakes(
    "BIAS_HOLDS_WHITE_NOISE",
    "Without a walk, the bias that your code returns varies, and it contains all of the white noise.",
    "Return the random walk alone as the bias; the white noise belongs only to the measured rate.",
)
mistakes(
    "NOISE_FOR_BIAS",
    "Your code returns the white noise as the bias.",
    "Return (measured, bias), where the bias is bias0 plus its random walk.",
)
mistakes(
    "WALK_TOO_SMALL",
    "For most recordings the random walk is too small.",
    "Half the mean square of the differences of neighbouring block means is N²/T + K² T/3, with T in seconds. Compare your formula with it: is each term there, and each factor? The walk shows in long blocks.",
    kind="consequence",
)
mistakes(
    "WALK_TOO_LARGE",
    "For most recordings the random walk is too large.",
    "Half the mean square of the differences of neighbouring block means is N²/T + K² T/3, with T in seconds. Compare your formula with it: is each term there, and each factor? Without N²/T, noise is taken for walk.",
    kind="consequence",
)
mistakes(
    "BIAS0_TIME_TOO_LONG",
    "bias0 is the mean of too many samples from the start, and the bias has drifted meanwhile.",
    "Average about sqrt(3) N/K seconds: divide by dt to get the number of samples.",
)
mistakes(
    "WALK_SCATTERS",
    "The random walk is too large for some recordings and too small for others.",
    "Use all of the recording, in blocks of many lengths up to a twelfth of it: of the longest there are few, and their mean square is mostly chance. If your code fits one equation for each length, divide each by its own size, or the large ones outweigh the small ones.",
)
mistakes(
    "FIT_SWAPPED",
    "noise_density is about what bias_random_walk should be, and the other way round.",
    "N goes with 1/T and K with T/3: check which of the two fitted numbers is which.",
)
mistakes(
    "ROOT_FORGOTTEN",
    "A number that your code returns is about the square of the one that is asked for.",
    "The Allan variance is N²/T + K² T/3: what comes out of it is N² and K², so take the square root. If you take it, look at the columns of the fit: 1/T and T/3.",
)
mistakes(
    "DENSITY_TOO_LARGE",
    "For more than half of the recordings here, the noise density is too large.",
    "To compare: N² is half the mean square of the differences of neighbouring samples, times dt. A variance of the samples or block means themselves contains the drift as well, and so does the Allan variance at a single averaging time, such as 1 s: fit both terms to many.",
)
mistakes(
    "DENSITY_TOO_SMALL",
    "For more than half of the recordings here, the noise density is too small.",
    "To compare: N² is half the mean square of the differences of neighbouring samples, times dt. Does your code halve it twice, or take dt twice?",
)
mistakes(
    "FIT_WITHOUT_NOISE",
    "For most recordings the noise density is far too small and the walk far too large: what your code fits grows with T, where white noise makes it fall.",
    "Print the Allan variances: for short T they must be about N²/T. Each block gives the mean of its samples, not their sum.",
    kind="fact",
).edit("fit_noise", {"(total[size:] - total[:-size]) / size": "total[size:] - total[:-size]"})
mistakes(
    "DENSITY_SCATTERS",
    "The noise density is too large for some recordings and too small for others.",
    "N² is half the mean square of the differences of neighbouring samples, times dt. Use all the samples of a recording; in a fit of both terms, divide each equation by its own size.",
)
mistakes(
    "BEAM_REVERSED",
    "Each beam reads what lies in the opposite direction.",
    "A beam points along (cos, sin) of heading + angle, without a minus. If yours does, check the sign of the distance along the beam.",
)
mistakes(
    "POSITION_SIGN_FLIPPED",
    "The robot's position counts with the wrong sign.",
    "The vector from the robot to a wall is the wall minus the robot.",
)
mistakes(
    "POSITION_IGNORED",
    "Moving the robot does not change its readings.",
    "First subtract the robot's position from the end points of the walls.",
)
mistakes(
    "BEYOND_RANGE",
    "A wall further away than r_max is still measured.",
    "A hit beyond r_max does not count: the reading is exactly r_max.",
)
mistakes(
    "LONG_WALL_LEFT_OUT",
    "A beam that hits a long wall within range reads r_max. Ends of that wall are further away than r_max.",
    "Use the distance along the beam. How far the ends or the middle of a wall are says little about it.",
)
mistakes(
    "NOTHING_IS_HIT",
    "No beam that was tried hits a wall.",
    "For one beam and one wall ahead of it, print how far along the beam and at what fraction of the wall they cross. It is a hit if the first lies between 0 and r_max and the second between 0 and 1.",
    kind="consequence",
)
mistakes(
    "NO_HIT_NOT_MAX",
    "The reading of a beam that hits nothing is not r_max.",
    "Start from r_max, and let only hits reduce it.",
)
mistakes(
    "LIDAR_NOISE_MISSING",
    "With a sigma above zero, the readings of hits are exact: they have no noise.",
    "Add sigma times a standard normal number to each hit.",
)
mistakes(
    "LIDAR_SIGMA_WRONG",
    "Within one scan, the noise of the hits does not have the std sigma.",
    "Add sigma * rng.standard_normal(...), with a number of its own for each hit and no other factor.",
    kind="consequence",
)
mistakes(
    "PARALLEL_WALLS",
    "A beam parallel to a wall gives a wrong distance.",
    "There the cross product of the two directions is zero: treat that as no hit before you compare distances.",
)
mistakes(
    "ANGLES_IGNORED",
    "All beams point in the same direction.",
    "Each beam has its own angle and points along heading + angle.",
)
mistakes(
    "WALL_ENDS_MIXED",
    "The starting point of a wall and its direction do not belong together, or the position along the wall has the wrong sign.",
    "From its end a, the wall goes along b - a: use the same a in both. If you do, check the sign of the position along the wall.",
)
mistakes(
    "WALLS_ENDLESS_ONE_WAY",
    "A wall ends on one side only: on the other side your code treats it as endless.",
    "A hit lies between both ends: check 0 <= u and u <= 1.",
)
mistakes(
    "WALL_SHARE_IN_METRES",
    "The place along a wall, which is 0 at one end and 1 at the other, is mixed up with a length in metres.",
    "Compare like with like: the share of the wall with 0 and 1, or metres with 0 and the wall's length.",
).edit("lidar", {"(share <= 1)": "(share <= np.hypot(wx, wy))"}).edit(
    "lidar", {"(share <= 1)": "(share * np.hypot(wx, wy) <= 1)"}
)
mistakes(
    "DISTANCE_SQUARED",
    "The distance is squared.",
    "Take the square root, or use the parameter along a beam direction of length one.",
)
mistakes(
    "DISTANCE_ACROSS",
    "The reading is the shortest way to the wall, square to it, not the way along the beam.",
    "Return s, the distance at which beam and wall cross: p + s d = a + u w, with d = (cos, sin) of the beam's direction.",
)
mistakes(
    "DISTANCE_ALONG_WALL",
    "The reading is the place of the hit on the wall, not its distance along the beam.",
    "Of p + s d = a + u w, return s: it belongs to the beam, and u to the wall.",
)
mistakes(
    "DISTANCE_ALONG_HEADING",
    "Your code returns the distance straight ahead, not the distance along the beam.",
    "Return the length of the beam itself, without a factor of cosine.",
)
mistakes(
    "LIDAR_SIGMA_SQUARED",
    "The noise of the hits has the std sigma², not sigma.",
    "sigma is the std, not the variance: add sigma * rng.standard_normal(...).",
)
mistakes(
    "LIDAR_SIGMA_ROOT",
    "The noise of the hits has the std sqrt(sigma), not sigma.",
    "sigma is the std, not the variance: add sigma * rng.standard_normal(...).",
)
mistakes(
    "LIDAR_NOISE_PROPORTIONAL",
    "The noise grows with the distance.",
    "sigma is the same for every hit: add sigma * rng.standard_normal(...) without multiplying it by the distance.",
)
mistakes(
    "LIDAR_NOISE_UNIFORM",
    "The noise is uniformly distributed between two limits.",
    "Add sigma times a standard normal number: its std is sigma.",
)
mistakes(
    "NOISE_BEFORE_NEAREST",
    "Of two walls in the same place, the readings are too short: they are those of noise that is added to each wall, before the smallest is taken.",
    "Find the nearest wall without noise first. Then add noise to its distance, once for each beam.",
).edit(
    "lidar",
    {
        "np.where(hit, along, np.inf)": "np.where(hit, along + sigma * rng.standard_normal(along.shape), np.inf)",
        "nearest + sigma * rng.standard_normal(len(beam))": "nearest",
    },
)
mistakes(
    "WALLS_ALONG_AXES_MISSED",
    "A wall parallel to the x axis or to the y axis is not seen, while a slanted one is.",
    "If your code divides by a difference of two x or two y, or compares only one coordinate with the ends: use the place u along the wall. From p + s d = a + u w, a hit has u between 0 and 1, and this holds for every direction of a wall.",
).edit("lidar", {"(cross != 0) &": "(cross != 0) & (wx != 0) &"}).edit(
    "lidar", {"(cross != 0) &": "(cross != 0) & (wy != 0) &"}
)
mistakes(
    "WALLS_MISSED_BY_ROUNDING",
    "Some beams pass through a wall that is parallel to an axis, and none through the same wall turned.",
    "A hit lies a rounding error beside its wall, so do not compare its x and y with the corners: a hit has its place between the ends, from 0 to 1.",
).edit(
    "lidar",
    {
        "    with np.errstate(": "    (px, py), (qx, qy) = segments[:, 0].T, segments[:, 1].T\n    with np.errstate(",
        "(share >= 0) & (share <= 1)": "(np.minimum(px, qx) <= x + along * dx) & (x + along * dx <= np.maximum(px, qx)) & (np.minimum(py, qy) <= y + along * dy) & (y + along * dy <= np.maximum(py, qy))",
    },
)
mistakes(
    "NEAR_WALL_NOT_SEEN",
    "A wall very close to the robot is not seen: its beam reads r_max.",
    "A hit counts at every distance from zero on: compare the distance along the beam with 0.",
).edit("lidar", {"(along >= 0)": "(along >= 0.15)"})
mistakes(
    "LIDAR_NOISE_ONE_SIDED",
    "The noise always has the same sign.",
    "A standard normal number is negative as often as positive: use it as it is.",
)
mistakes(
    "RANGE_MADE_POSITIVE",
    "A reading that the noise makes negative gets its sign removed.",
    "Set it to zero instead: np.maximum(..., 0.0).",
)
mistakes(
    "LAG_IMPLICIT",
    "The fraction of the way is dt / (tau + dt). That is stable, but a little too slow at every step.",
    "Use the exact solution: the fraction is 1 - exp(-dt / tau).",
)
mistakes(
    "LAG_LINEAR_IF_SHORT",
    "A step that is short beside tau does not cover 1 - exp(-dt / tau) of the way, while a longer one does.",
    "Use 1 - exp(-dt / tau) for every step, however short: dt / tau is only near it.",
).edit(
    "motor_step", {"- math.expm1(-dt / tau)": "+ (dt / tau if dt < 0.1 * tau else -math.expm1(-dt / tau))"}
)
mistakes(
    "LAG_INVERTED",
    "The fraction of the way that is covered and the fraction that is left are swapped.",
    "w + (1 - exp(-dt / tau)) * (u - w): after a long time, w equals u.",
)
mistakes(
    "LAG_MISSING",
    "The speed reaches the command at once.",
    "In a time dt it covers the fraction 1 - exp(-dt / tau) of the way from w to u.",
)
mistakes(
    "SATURATION_MISSING",
    "A command beyond u_max is followed in full.",
    "Clip u to [-u_max, u_max] before the lag.",
)
mistakes(
    "SATURATION_OF_DIFFERENCE",
    "The difference of command and speed is clipped to u_max, not the command.",
    "Clip u to [-u_max, u_max]. The difference u - w may be larger.",
)
mistakes(
    "SATURATION_ONE_SIDED",
    "Commands are limited in one direction but not in the other.",
    "Clip on both sides: min(max(u, -u_max), u_max).",
)
mistakes(
    "DEADBAND_MISSING",
    "A command inside the dead band moves the motor.",
    "Where abs(u) <= deadband, the command counts as 0.",
)
mistakes(
    "DEADBAND_ONE_SIDED",
    "A negative command inside the dead band moves the motor.",
    "Compare the absolute value: abs(u) <= deadband.",
)
mistakes(
    "DEADBAND_STOPS_MOTOR",
    "Inside the dead band the speed stops or stays constant, where it should decay.",
    "Inside the dead band the command counts as 0, so the speed lags towards 0.",
)
mistakes(
    "DEADBAND_OF_DIFFERENCE",
    "The dead band is applied to the difference of command and speed: where it is small, the speed stays as it is.",
    "The dead band belongs to the command alone: u counts as 0 where abs(u) <= deadband, whatever the speed is.",
)
mistakes(
    "DEADBAND_OF_SPEED",
    "The dead band is applied to the speed: a new speed within it becomes 0.",
    "The dead band belongs to the command: u counts as 0 where abs(u) <= deadband. The speed lags towards it and is not cut.",
)
mistakes(
    "DEADBAND_REVERSED",
    "Small commands are followed, and large ones count as 0.",
    "A command counts as 0 where abs(u) <= deadband, and keeps its value otherwise.",
)
mistakes(
    "BACKWARDS_SWALLOWED",
    "Negative commands count as 0.",
    "The dead band and the limit both depend on the absolute value of a command: abs(u) <= deadband, and min(max(u, -u_max), u_max).",
)
mistakes(
    "SATURATION_AS_SWITCH",
    "A command beyond u_max counts as 0.",
    "Saturation means that such a command counts as u_max, with its sign: min(max(u, -u_max), u_max).",
)
mistakes(
    "LAG_RATIO_INVERTED",
    "The exponent is tau / dt, where it should be dt / tau.",
    "The fraction of the way that is covered is 1 - exp(-dt / tau): it grows with dt.",
)
mistakes(
    "LAG_OF_PRODUCT",
    "The exponent is dt times tau.",
    "An exponent has no unit, so it must be dt / tau.",
)
mistakes(
    "LAG_SIGN",
    "The speed moves away from the command, not towards it.",
    "w + (1 - exp(-dt / tau)) * (u - w): check the signs of the exponent and of u - w.",
)
mistakes(
    "LAG_BASE",
    "The lag uses a base other than e.",
    "tau is the time in which the remaining difference shrinks to 1/e, so use math.exp(-dt / tau).",
)
mistakes(
    "LAG_OFF_BY_FACTOR",
    "The lag is twice as long as tau, or half as long.",
    "The fraction is 1 - exp(-dt / tau), without a factor in the exponent.",
)
mistakes(
    "LAG_SHARE_WRONG",
    "The speed covers a fraction of the way from w to the command, but not the right one.",
    "The fraction is 1 - exp(-dt / tau), with the dt and the tau of this call.",
    kind="consequence",
)
mistakes(
    "SPEED_IGNORED",
    "The motor starts from rest, whatever its speed w is.",
    "Start from the speed that the motor has: w + (1 - exp(-dt / tau)) * (u - w).",
)
mistakes(
    "SPEED_GROWS",
    "The fraction is taken of the command, not of the difference to it, so the speed does not settle at the command.",
    "w + (1 - exp(-dt / tau)) * (u - w): the remaining difference is u - w.",
)
mistakes(
    "RETURNS_CHANGE",
    "Your code returns the change of the speed, not the new speed.",
    "Add w to it.",
)
mistakes(
    "BACKLASH_MISSING",
    "The output follows the input as if there were no play.",
    "The output stays at rest until the input has crossed the gap: clip the state to [x - gap/2, x + gap/2].",
)
mistakes(
    "BACKLASH_SNAPS",
    "Once the gap is crossed, the output jumps to the input itself.",
    "The edge of the gap pushes the output, so the output stays gap/2 behind the input.",
)
mistakes(
    "GAP_HALVED",
    "The play is half as wide as the gap.",
    "Half of the gap is on either side of the input, from x - gap/2 to x + gap/2.",
)
mistakes(
    "BACKLASH_SIDE_OF_ZERO",
    "Which edge of the gap pushes the output depends on the sign of x, and not on where the state is.",
    "Compare x with the state, not with 0: a state below x - gap/2 is pushed up to it, and one above x + gap/2 down to that.",
)
mistakes(
    "BACKLASH_NEVER_RESTS",
    "The output is half a gap from the input after nearly every step: inside the gap it does not stay at rest.",
    "Clip the state to [x - gap/2, x + gap/2]: between these limits the output stays where it is. Return it as the next state, too.",
)
mistakes(
    "BACKLASH_ONE_SIDED",
    "The output is pushed in one direction but not in the other.",
    "The gap has two edges: clip the state to [x - gap/2, x + gap/2].",
)
mistakes(
    "BACKLASH_WRONG_EDGE",
    "When it is pushed, the output is at the far edge of the gap, ahead of the input.",
    "The output trails the input: pushed forwards it is at x - gap/2, pushed backwards at x + gap/2.",
)
mistakes(
    "BACKLASH_SAME_SIDE",
    "The output is always on the same side of the input and as far from it, whatever the state is.",
    "min(max(state, x - gap/2), x + gap/2): the lower limit belongs to max, the upper one to min.",
)
mistakes(
    "GAP_SCALED",
    "Pushed either way, the output stays as far behind the input each time, but not by half the gap.",
    "Half of the gap is on either side: pushed forwards y is x - gap/2, pushed backwards x + gap/2.",
)
mistakes(
    "BACKLASH_CLIPS_INPUT",
    "Your code clips the input to a gap around the state, so the output moves by half a gap at most.",
    "Clip the state instead, to [x - gap/2, x + gap/2].",
)
mistakes(
    "BACKLASH_HOLDS",
    "The output does not move, even where an edge of the gap should push it.",
    "The edges of the gap push the output: clip the state to [x - gap/2, x + gap/2].",
)
mistakes(
    "BACKLASH_ADDS_INPUT",
    "The position of the input is added to the state.",
    "x is a position, not a step: the output is the state, clipped to [x - gap/2, x + gap/2].",
)
mistakes(
    "OUTPUT_IS_NOT_STATE",
    "The output is a different number from the state that is returned with it.",
    "Return (y, y): the output is the new state.",
)
mistakes(
    "DELAY_WRAPS",
    "The end of the signal appears at its beginning.",
    "np.roll moves the end round to the beginning, and negative indices count from the end. Before the first sample the output is 0.0.",
)
mistakes(
    "DELAY_IN_SAMPLES",
    "The latency is used as a number of samples.",
    "The latency is in seconds, and that is latency / dt samples.",
)
mistakes(
    "DELAY_RAMPS_IN",
    "The output begins to change before the first sample has arrived.",
    "Until the first sample arrives the output is exactly 0.0, not a line from 0 to that sample.",
)
mistakes(
    "DELAY_FIRST_LOST",
    "Without latency, the output begins with 0.0 and not with the first sample.",
    "The output is 0.0 before the latency, but not at it: set it to 0.0 where t < latency, with < and not <=.",
).edit("delay_line", {"interp(t - latency, t, x, left=": "where(t > latency, np.interp(t - latency, t, x), "})
mistakes(
    "DELAY_OF_PRODUCT",
    "The latency is multiplied by dt.",
    "Counted in samples it is latency / dt; in seconds, as np.interp needs it, it is latency itself.",
)
mistakes(
    "DELAY_IGNORED",
    "The signal is not delayed.",
    "The output at time k*dt is the signal of the time k*dt - latency.",
)
mistakes(
    "DELAY_AS_LAG",
    "The signal is smoothed, as behind a lag, and not delayed.",
    "A delay keeps the shape of the signal: the output at time k*dt is the signal of the time k*dt - latency.",
).body(
    "delay_line",
    """
        y, value = np.zeros(len(x)), 0.0
        share = 1 - math.exp(-dt / latency) if latency > 0 else 1.0
        for k in range(len(x)):
            value += share * (x[k] - value)
            y[k] = value
        return y
    """,
)
mistakes(
    "DELAY_COVERS_START",
    "The signal is zero at first, but then it comes without a delay.",
    "The first sample comes at the time latency, and all others as much later: y at k*dt is x at k*dt - latency.",
)
mistakes(
    "DELAY_ONE_TOO_LONG",
    "The output is one sample late.",
    "y[k] is x at the time k*dt - latency, where k starts from 0.",
)
mistakes(
    "DELAY_ONE_TOO_SHORT",
    "The output is one sample early.",
    "y[k] is x at the time k*dt - latency, where k starts from 0.",
)
mistakes(
    "DELAY_NAN_BEFORE",
    "Before the first sample the output is nan.",
    "Before the first sample has arrived, return 0.0.",
    kind="nan",
)
mistakes(
    "DELAY_SHARES_SWAPPED",
    "Between two samples, the further one gets the larger weight.",
    "At the fraction p of the way from one sample to the next, the value is (1 - p) times the first plus p times the next.",
)
mistakes(
    "DELAY_NOT_STRAIGHT",
    "With a latency of two samples the output is right. With one of two and a half it is not on the straight line between two samples.",
    "Use np.interp with left=0.0. If your code draws a curve through the samples, or shifts them by a Fourier transform, it gets other values between them.",
    kind="fact",
)
mistakes(
    "DELAY_OF_WHOLE_NUMBERS",
    "From whole numbers come whole numbers: what lies between two samples loses its decimals.",
    "Make the result an array of floats: np.zeros(len(x)). np.zeros_like(x) takes the type of x.",
).around("delay_line", "return _right(x, dt, latency).astype(np.asarray(x).dtype)")
mistakes(
    "DELAY_GOES_ON_BACKWARDS",
    "Less than a sample before the first one the output is not 0: it lies on the line through the first two samples, drawn on backwards.",
    "int() cuts -0.5 to 0: ask whether the place is below 0 before you cut it, or take math.floor.",
).body(
    "delay_line",
    """
        x = np.asarray(x, dtype=float)
        y = np.zeros(len(x))
        for k in range(len(x)):
            place = k - latency / dt
            i = int(place)
            if i >= 0 and place > -1:
                share = place - i
                y[k] = x[i] + share * (x[min(i + 1, len(x) - 1)] - x[i])
        return y
    """,
)
mistakes(
    "DELAY_SHARE_WRONG",
    "With a latency of two samples and a half, the samples on either side do not count half each.",
    "Divide the latency by dt before you split it: its whole part is a number of samples, and the rest, from 0 to 1, is the share of the earlier one.",
    kind="fact",
).body(
    "delay_line",
    """
        n = math.floor(latency / dt + 1e-9)
        rest = latency - n * dt
        late = np.concatenate((np.zeros(n + 1), x))
        return (1 - rest) * late[1 : len(x) + 1] + rest * late[: len(x)]
    """,
)
mistakes(
    "DELAY_SHARE_NEGATIVE",
    "The output is on the line through the wrong two samples: one share is negative, as it is where latency / dt is rounded up.",
    "If your code rounds latency / dt, round down, with math.floor: then the rest lies between 0 and 1, and so do the shares of both samples.",
)
mistakes(
    "DELAY_HALF_WAY",
    "Between two samples the output is always their mean.",
    "Interpolate along the straight line between them: the nearer sample gets the larger weight.",
)
mistakes(
    "EULER_TURNS_FIRST",
    "The robot turns first and then drives straight along the new heading.",
    "Move along the arc: its chord points along the heading at the middle of the turn, and its length is that of the arc times sin(turn/2)/(turn/2).",
)
mistakes(
    "TRACK_HALVED",
    "The robot turns twice as fast as it should.",
    "The wheels are a whole track apart: (v_right - v_left) / track.",
)
mistakes(
    "TRACK_DOUBLED",
    "The robot turns half as fast as it should.",
    "The wheels are one track apart: (v_right - v_left) / track.",
)
mistakes(
    "SPEEDS_ADDED",
    "The robot goes twice as far as it should.",
    "The speed at the middle of the axle is the mean of the two wheel speeds.",
)
mistakes(
    "STRAIGHT_DIVIDES_BY_ZERO",
    "With equal wheel speeds the result is not a number. Dividing by a turn rate of 0 gives that.",
    "Treat a turn rate of 0 separately, or use np.sinc(turn / (2 * pi)), which is 1 there.",
    kind="nan",
)
mistakes(
    "SPEED_IS_DIFFERENCE",
    "The robot moves forwards at half the difference of the two wheel speeds.",
    "The speed at the middle of the axle is their mean, (v_left + v_right) / 2.",
)
mistakes(
    "SPEED_OF_ONE_WHEEL",
    "The robot moves forwards at the speed of one of its wheels.",
    "The speed at the middle of the axle is the mean, (v_left + v_right) / 2.",
)
mistakes(
    "TRACK_MULTIPLIED",
    "The difference of the wheel speeds is multiplied by the track, not divided by it.",
    "A wider robot turns more slowly, so divide by the track.",
)
mistakes(
    "TRACK_IGNORED",
    "The turn rate does not depend on the track.",
    "The turn rate is (v_right - v_left) / track.",
)
mistakes(
    "TURN_WITHOUT_DT",
    "The robot turns by the same angle, however long the step is.",
    "The turn is the turn rate times dt.",
)
mistakes(
    "CHORD_OF_WHOLE_TURN",
    "The chord is computed with the whole turn.",
    "Use half of the turn: sin(turn/2)/(turn/2).",
)
mistakes(
    "CHORD_ON_ONE_SIDE",
    "In turns to one side the displacement is as long as the arc, as on a straight line.",
    "The chord is shorter than its arc in turns to either side. If your code asks whether a turn is slow, compare abs(turn); np.sinc(turn / (2 * pi)) needs no such question.",
)
mistakes(
    "SERIES_OF_WHOLE_TURN",
    "In slow turns, the length of the chord is that of 1 - turn²/6, where the whole turn stands for its half.",
    "The factor is sin(turn/2)/(turn/2). Its series begins with 1 - turn²/24; np.sinc(turn / (2 * pi)) needs none.",
)
mistakes(
    "CHORD_INVERTED",
    "The chord is longer than its arc.",
    "Multiply by sin(turn/2)/(turn/2), which is at most 1; do not divide by it.",
)
mistakes(
    "WAY_WITHOUT_DT",
    "The length of the arc is taken without dt, or with a fixed one.",
    "The distance is v * dt.",
)
mistakes(
    "CHORD_ALONG_OLD_HEADING",
    "The chord points along the heading before the turn.",
    "The chord points along the heading half-way through the turn: heading + turn/2.",
)
mistakes(
    "CHORD_ALONG_NEW_HEADING",
    "The chord points along the heading after the turn.",
    "The chord points along the heading half-way through the turn: heading + turn/2.",
)
mistakes(
    "CHORD_WRONG_WAY",
    "In a turn that was tried, the displacement has the right length but the wrong direction.",
    "The chord points along the heading half-way through the turn: use the cosine and the sine of heading + turn/2, with the heading from before the step.",
)
mistakes(
    "TURN_ON_THE_SPOT_LOST",
    "Where the wheels run against each other at one speed, the robot stays as it is.",
    "Its middle stays, and it turns: the heading changes by (v_right - v_left) / track * dt all the same.",
).edit(
    "diff_drive_step",
    {
        "x, y, heading = pose\n": "x, y, heading = pose\n    if v_left + v_right == 0:\n        return np.array(pose, dtype=float)\n"
    },
)
mistakes(
    "RIGHT_TURNS_BACKWARDS",
    "In a turn to the right, the robot goes backwards along its chord.",
    "There turn and sin(turn/2) are both negative, and their quotient is positive: take the absolute value of neither.",
).edit(
    "diff_drive_step",
    {"np.sinc(turn / (2 * math.pi))": "np.sinc(turn / (2 * math.pi)) * (-1 if turn < -1e-9 else 1)"},
)
mistakes(
    "CHORD_TURNED_BACK",
    "The chord is rotated to the wrong side.",
    "The chord points along the heading half-way through the turn: heading + turn/2, with a plus.",
)
mistakes(
    "Y_MIRRORED",
    "y changes in the wrong direction.",
    "y grows with the sine of heading + turn/2, with a plus.",
)
mistakes(
    "HEADING_NOT_TURNED",
    "The heading that is returned is the old one.",
    "Return heading + turn.",
)
mistakes(
    "SLOW_TURN_NOT_TURNED",
    "In some slow turns the heading that is returned is the old one.",
    "Return heading + turn in every case, also where the chord counts as straight.",
).around(
    "diff_drive_step",
    """
        x, y, heading = _right(pose, v_left, v_right, track, dt)
        return np.array([x, y, pose[2] if abs(heading - pose[2]) < 1e-4 else heading])
    """,
)
mistakes(
    "HEADING_HALF_TURNED",
    "The heading changes by only half of the turn.",
    "Half of the turn gives the direction of the chord; the new heading is heading + turn.",
)
mistakes(
    "HEADING_FORGOTTEN",
    "Your code returns the turn as the new heading.",
    "Add the turn to the old heading: heading + turn.",
)
mistakes(
    "POSE_FORGOTTEN",
    "Each step starts from the origin.",
    "Add the step to the pose that is passed in.",
)
mistakes(
    "SECOND_MISTAKE",
    "The mistake that another check names makes no difference to these numbers: there is a second one.",
    "Mend the named one first, then check again.",
    kind="fact",
)
mistakes(
    "RETURNS_SWAPPED",
    "Your code returns the right two things in the wrong order.",
    "Return them in the order that the README gives.",
)

# -- sync

mistakes(
    "TIME_NOT_ADVANCED",
    "After a new measurement, the twin's time is the same as before.",
    'Return "t": max(twin["t"], t_measured).',
)
mistakes(
    "NO_CORRECTION",
    "The measurement does not correct the position.",
    "Move the position by a share of the surprise, which is z minus what the twin expected.",
)
mistakes(
    "SMALL_SURPRISES_IGNORED",
    "A surprise of one standard deviation of the measurements does not move the position at all, while a larger one does.",
    "Correct by a share of every surprise, small ones too: that is how the noise is averaged out.",
)
mistakes(
    "TIME_NOT_THE_LATEST",
    "After a measurement that is newer than all others, the twin's `t` is not its time.",
    'Predict from twin["t"] to t_measured, and return t_measured as `t`. Only a late measurement leaves `t` as it was.',
    kind="consequence",
)
mistakes(
    "NO_PREDICTION",
    "Between two measurements the twin hardly moves, apart from what the measurement corrects.",
    'First predict the state at t_measured from the speed, the drive and the friction, over t_measured - twin["t"] seconds. Then correct it.',
)
mistakes(
    "SURPRISE_OF_OLD_POSITION",
    "The surprise is the measured position minus the position from before the prediction.",
    "Predict first; the surprise is z minus the predicted position at t_measured.",
).edit("sync", {"_correct(state, spread, seen,": "_correct(state, spread, seen + state[0] - last[3],"})
mistakes(
    "PREDICTS_TOO_LITTLE",
    "Where a measurement brings no surprise, the twin has moved less far than its speed would take it in that time.",
    'Predict over all of t_measured - twin["t"], in SI units, x + v * dt to begin with. The new position is this prediction plus a share of the surprise.',
)
mistakes(
    "SHARE_OVER_ONE",
    "The position moves beyond the measurement: it is corrected by more than all of the surprise.",
    "Move the position only a share of the way to z, a third for example: the prediction contains information too.",
)
mistakes(
    "MEMORY_TOO_LARGE",
    "The memory is larger than the README allows, whether it grows or not.",
    "Keep the last second or two of the history, and of it only the numbers that a later call reads.",
    kind="fact",
)
mistakes(
    "DRIVE_REMEMBERED",
    "A drive that was changed between two calls makes no difference to the next prediction, although it does for a new twin.",
    'Take twin["drive"] from the twin that is passed in. It acts from the twin\'s time on, and the caller may change it.',
)
mistakes(
    "SPEED_SHARE_OVER_DT",
    "A surprise changes the speed by a share of it that is divided by the time since the last measurement.",
    "Divided by 0.1 s, a share is ten times as large, and so is the noise that comes with it. About 0.3 of the surprise itself is enough for the speed.",
    kind="fact",
)
mistakes(
    "LATE_STATE_AS_CURRENT",
    "After a late measurement, the position is about that of the earlier time, while `t` is the time before the call.",
    'A state predicted at t_measured has to be predicted on to twin["t"] again before it is returned. You may also ignore late measurements.',
)
mistakes(
    "SPEED_CORRECTED_BACKWARDS",
    "A measurement ahead of the twin makes its speed smaller.",
    "A cart that is further ahead than expected is faster than the twin assumes: add a share of the surprise, which is z minus the prediction, to the speed.",
)
mistakes(
    "SPEED_NOT_CORRECTED",
    "A surprise does not change the speed.",
    "Correct the speed by a share of the surprise too: a cart that is further ahead than expected is faster than the twin assumes.",
)
mistakes(
    "FRICTION_NOT_IN_MODEL",
    "The prediction ignores the friction.",
    "dv/dt = drive - friction * speed.",
)
mistakes(
    "FRICTION_WITHOUT_SPEED",
    "In the prediction, friction takes as much speed off a fast cart as off a slow one.",
    "Multiply it by the speed: dv/dt = drive - friction * speed.",
).body("sync", _observer({"- b * v": "- b * x"}))
mistakes(
    "POSITION_OF_OLD_SPEED",
    "The predicted position is that of a cart that keeps its old speed, although the predicted speed is another one.",
    "With a = drive - friction * v, predict x + v * dt + a * dt**2 / 2, or go there in small steps.",
).body("sync", _observer({"dt * v + dt * dt / 2 * a": "dt * v"}))
mistakes(
    "FRICTION_ONE_WAY",
    "The friction moves in one direction only, whichever sign the surprise has.",
    "Take the surprise with its sign: a cart that falls behind has more friction, and one that gets ahead has less.",
).body("sync", _observer({"surprise * np.sign(v)": "abs(surprise)"}))
mistakes(
    "LAST_BIAS_LEFT_OUT",
    "The last step of the bias is far larger than the others.",
    "N samples take N - 1 steps, so the last bias is the one before plus a step. Does your loop end one sample too early?",
).body(
    "imu",
    """
        n = len(true)
        bias = np.full(n, float(bias0))
        for k in range(n - 2):
            bias[k + 1] = bias[k] + bias_random_walk * math.sqrt(dt) * rng.standard_normal()
        return true + bias + noise_density / math.sqrt(dt) * rng.standard_normal(n), bias
    """,
)
mistakes(
    "FRICTION_SIGN_OF_DRIVE",
    "With a drive against the motion, a surprise changes the friction in the wrong direction.",
    "The sign of the correction is that of the speed, whichever way the drive pushes: a cart that rolls forwards and falls behind has more friction.",
).body(
    "sync",
    _observer(
        {
            "v + 0.3": "v + 0.4",
            "min(max(b - 0.15": "max(b - 0.4",
            "np.sign(v), 0.05), 5.0)": '(1 if twin["drive"] > 0 else -1), 0.01)',
        }
    ),
)
mistakes(
    "LARGE_SURPRISES_DROPPED",
    "A large surprise changes nothing, while a small one does: neither position nor speed nor friction takes a share of it.",
    "Correct by a share of every surprise. After a jump of the friction the surprises are large because the twin is wrong, not because the measurement is.",
).edit(
    "sync",
    {
        '_correct(state, spread, seen, twin["sigma"])': '_correct(state, spread, seen, twin["sigma"]) if abs(seen - state[0]) < 1.5 * twin["sigma"] else (state, spread)'
    },
)
mistakes(
    "SURPRISE_LIMITED",
    "A surprise of 5 stds moves the position hardly further than a surprise of 2.",
    "Correct by the same share of every surprise. After a jump of the friction the surprises are large because the twin is wrong, not because the measurement is.",
    kind="fact",
).edit(
    "sync",
    {
        '_correct(state, spread, seen, twin["sigma"])': '_correct(state, spread, float(np.clip(seen, *(state[0] + np.array([-1, 1]) * twin["sigma"]))), twin["sigma"])'
    },
)
mistakes(
    "FRICTION_SHARE_TOO_LARGE",
    "The friction is corrected by more than all of a surprise, in SI units. It swings with the noise of the measurements.",
    "Correct it by a smaller share: about -0.15 is enough at ten measurements a second.",
)
mistakes(
    "FRICTION_LEARNS_SLOWLY",
    "The friction moves in the right direction, but does not reach its true value in time.",
    "Look for what holds it back: for example a small share (about -0.15 is enough at ten measurements a second, beside 0.3 for the speed), a speed that takes nearly all of each surprise, little process noise in a Kalman filter, or a limit.",
    kind="consequence",
)

# -- command

mistakes(
    "TARGET_IGNORED",
    "At the target speed, the drive does not depend on how large that speed is.",
    "At a steady speed, drive = friction * speed.",
)
mistakes(
    "BRAKES",
    "At the target speed, the drive points in the wrong direction.",
    "Friction slows the robot down, so the drive must point along the target speed.",
)
mistakes(
    "ADDS_CURRENT_DRIVE",
    "The result depends on the drive that acts at the moment.",
    'Leave twin["drive"] out of it, and return the drive itself, not a change of it: friction * target_speed, and a correction if you like.',
)
mistakes(
    "FRICTION_ADDED",
    "Something is added to the friction before it is multiplied by the target speed.",
    "drive = friction * target_speed, with the friction as it is.",
)
mistakes(
    "FRICTION_ON_SURPLUS",
    "The friction is multiplied by another speed than the target speed.",
    "At the target speed the drive must be friction * target_speed. A correction with target_speed - speed may be added to it.",
)
mistakes(
    "TARGET_SQUARED",
    "At the target speed, the drive grows with the square of that speed, where it should be proportional to it.",
    "This friction is viscous: drive = friction * target_speed, to the first power.",
)
mistakes(
    "FRICTION_SQUARED",
    "The friction is squared.",
    "drive = friction * target_speed, to the first power.",
)
mistakes(
    "FRICTION_WITHOUT_TARGET",
    "At the target speed, the drive is as large as the friction, however large that speed is.",
    "Multiply it by target_speed.",
)
mistakes(
    "DRIVE_OFF_BY_FACTOR",
    "At the target speed, the drive is too large or too small by a constant factor.",
    "drive = friction * target_speed, without any other factor.",
)
mistakes(
    "BALANCE_MISSING",
    "At the target speed, nothing in the drive balances the friction.",
    "At a steady speed, drive = friction * target_speed; a correction may be added to that.",
)


formulas, motions = (kit.sibling(__file__, name) for name in ("formulas", "motions"))


@mistakes.more
def hypotheses():
    """Task, codes of what is wrong, and function of each, those with one mistake first."""
    for task, families in (formulas.TERMS | motions.TERMS).items():
        for codes, function in motions.OTHERS.get(task, ()):
            yield task, codes, function
        for family, base, terms in families:
            for term, forms in terms.items():
                for code, form in forms:
                    yield task, (*_of_base(base), code), family(**base | {term: form})
        for family, base, terms in families[:2]:  # what a third has twice, the first two have
            yield from _pairs(task, family, base, terms)


def _of_base(base):
    """What is wrong with a family before any of its terms is, whatever else."""
    if base is motions._EULER:
        return ("EULER_ODOMETRY",)
    if base.get("gain", 0.0) < 0.0:
        return ("PUSHES_AWAY",)
    return ("EULER_TURNS_FIRST",) if base is motions._TURNED_FIRST else ()


#: Mistakes that hardly anybody makes together with another: the table has room for 260 pairs of a task.
_ALONE = {
    *("LAG_BASE", "LAG_OF_PRODUCT", "LAG_OFF_BY_FACTOR", "LAG_RATIO_INVERTED", "DEADBAND_REVERSED"),
    *("SPEED_GROWS", "SATURATION_AS_SWITCH"),
    *("ANGLES_IGNORED", "BEAM_REVERSED", "NOTHING_IS_HIT", "POSITION_SIGN_FLIPPED", "RANGE_MADE_POSITIVE"),
    *("LIDAR_SIGMA_ROOT", "LIDAR_NOISE_ONE_SIDED", "LIDAR_NOISE_UNIFORM", "DISTANCE_ALONG_HEADING"),
    *("LIDAR_NOISE_PROPORTIONAL", "DISTANCE_SQUARED"),
    *("WHITE_NOISE_TIMES_DT", "WHITE_NOISE_ONE_SIDED", "BIAS_WALKS_TO_BIAS0", "BIAS_OVER_SQRT_DT"),
    *("NOISE_FOR_BIAS", "BIAS_SUBTRACTED", "TRUE_RATE_MISSING", "BIAS0_ADDED_EACH_STEP"),
    *("BIAS_CONSTANT", "WHITE_NOISE_MISSING", "WALK_SQUARED", "DENSITY_SQUARED"),
    *("Y_MIRRORED", "SPEED_IS_DIFFERENCE", "HEADING_HALF_TURNED", "CHORD_TURNED_BACK", "TRACK_MULTIPLIED"),
    *("CHORD_ON_ONE_SIDE", "SERIES_OF_WHOLE_TURN", "BACKLASH_SIDE_OF_ZERO", "BACKLASH_SAME_SIDE"),
    *("SPEED_OF_ONE_WHEEL", "WAY_WITHOUT_DT", "TRACK_IGNORED", "HEADING_FORGOTTEN"),
}


def _pairs(task, family, base, terms):
    """Two terms wrong at once, each in the first form of its code."""
    if _of_base(base):
        return  # that would be three
    firsts = {
        term: [(code, form) for code, form in dict(reversed(forms)).items() if code not in _ALONE]
        for term, forms in terms.items()
    }
    for one, other in itertools.combinations(terms, 2):
        for (code, form), (second, another) in itertools.product(firsts[one], firsts[other]):
            if code != second:
                yield task, (code, second), family(**base | {one: form, other: another})
