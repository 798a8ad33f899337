"""Five tests with known answers, for scripts that drive an engine through its own interface and nothing else.

An engine's script gives a function ``make(bodies, settings, gravity, friction, restitution, floor)``. It
returns two functions: ``step()`` goes on by one step of ``STEP`` seconds, ``read(i)`` gives body i's place
(m) and velocity (m/s). A body is a tuple (shape, half size in m, mass in kg, place, velocity).

Nothing here imports the course. What the course says about an engine is confirmed by code that shares no
line with the course's adapters; a mistake in one of the two shows as a difference.
"""

import json
import math
import statistics

STEP = 1.0 / 240.0
G = 9.81
PHASES = 64
STARTS = 5


def fall(make, settings):
    """By how many per cent a ball falls too far in 200 steps."""
    step, read = make([("ball", 0.1, 1.0, (0, 0, 0), (0, 0, 0))], settings, (0, 0, -G), 0.0, 0.0, False)
    for _ in range(200):
        step()
    return [100.0 * (-read(0)[0][2] / (0.5 * G * (200 * STEP) ** 2) - 1.0)]


def rebound(make, settings, height=1.0):
    """How high a ball comes back that falls from ``height`` with restitution 0.5, m, for each phase.

    A phase is a start so much further down the same fall: the energy is the same, the landing is earlier.
    """
    return [_rebound(make, settings, height, (k + 0.5) / PHASES * STEP) for k in range(PHASES)]


def _rebound(make, settings, height, late):
    start = height - 0.5 * G * late**2
    ball = ("ball", 0.1, 1.0, (0, 0, 0.1 + start), (0, 0, -G * late))
    step, read = make([ball], settings, (0, 0, -G), 0.0, 0.5, True)
    fall_s = math.sqrt(2.0 * height / G)
    lowest, highest, up = height, 0.0, False
    for _ in range(round(1.95 * fall_s / STEP)):
        step()
        (_x, _y, z), (_vx, _vy, vz) = read(0)
        lowest = min(lowest, z - 0.1)
        up = up or (lowest < height / 2 and vz > 0)
        if up:
            highest = max(highest, z - 0.1)
    return highest


def small_rebound(make, settings):
    """The same from 2 cm, mm."""
    return [1000.0 * value for value in rebound(make, settings, 0.02)]


def clash(make, settings):
    """By how many per cent an elastic collision of 1 kg at 1 m/s with 3 kg at rest changes the energy."""
    found = []
    for k in range(PHASES):
        light = ("ball", 0.1, 1.0, (-0.5 - (k + 0.5) / PHASES * STEP, 0, 1), (1, 0, 0))
        heavy = ("ball", 0.1, 3.0, (0, 0, 1), (0, 0, 0))
        step, read = make([light, heavy], settings, (0, 0, 0), 0.0, 1.0, False)
        for _ in range(240):
            step()
        one, other = read(0)[1], read(1)[1]
        energy = 0.5 * sum(c * c for c in one) + 1.5 * sum(c * c for c in other)
        found.append(100.0 * (energy / 0.5 - 1.0))
    return found


def slope(make, settings):
    """By how many per cent a cube accelerates too much: 30 degrees, friction 0.3, from 0.25 s to 1 s."""
    a = math.radians(30)
    gravity = (G * math.sin(a), 0, -G * math.cos(a))
    cube = ("cube", 0.25, 1.0, (0, 0, 0.25), (0, 0, 0))
    step, read = make([cube], settings, gravity, 0.3, 0.0, True)
    for _ in range(60):
        step()
    before = read(0)[1][0]
    for _ in range(180):
        step()
    true = G * (math.sin(a) - 0.3 * math.cos(a))
    return [100.0 * ((read(0)[1][0] - before) / 0.75 / true - 1.0)]


def tonne(make, settings):
    """How far two cubes of 20 cm move in 2 s, 1000 kg on 1 kg, mm; the larger of the two, for each start.

    From start to start the cubes are set off by a micrometre more, to either side, and the gaps between floor
    and cubes grow from an overlap of 1.5 micrometres to as much air and more.
    """
    return [_tonne(make, settings, k * 1e-6, (k - 1.5) * 1e-6) for k in range(STARTS)]


def _tonne(make, settings, off, gap):
    small = ("cube", 0.1, 1.0, (off, 0, 0.1 + gap), (0, 0, 0))
    large = ("cube", 0.1, 1000.0, (-off, 0, 0.3 + 2 * gap), (0, 0, 0))
    cubes = [small, large]
    step, read = make(cubes, settings, (0, 0, -G), 0.5, 0.0, True)
    starts = [read(i)[0] for i in range(2)]
    for _ in range(480):
        step()
    return 1000.0 * max(math.dist(read(i)[0], starts[i]) for i in range(2))


#: As the course calls them.
TESTS = {
    "free-fall": fall,
    "bounce": rebound,
    "small-drop": small_rebound,
    "clash": clash,
    "slide": slope,
    "mass-ratio": tonne,
}


def inertia(kind, size, mass):
    """About any axis through the centre of a ball or a cube, kg m²."""
    return (0.4 if kind == "ball" else 2.0 / 3.0) * mass * size**2


def true_swing(moment, n):
    """Where a ball of 1 kg on a rod of 1 m is after each of n steps, from the level of its hinge: (x, z), m.

    theta'' = -g sin(theta) / (1 + moment), by the classical Runge-Kutta method with a hundredth of a step.
    """
    theta, omega, h = math.pi / 2, 0.0, STEP / 100

    def rate(angle):
        return -G * math.sin(angle) / (1.0 + moment)

    for _ in range(n):
        for _ in range(100):
            a1, b1 = omega, rate(theta)
            a2, b2 = omega + h / 2 * b1, rate(theta + h / 2 * a1)
            a3, b3 = omega + h / 2 * b2, rate(theta + h / 2 * a2)
            a4, b4 = omega + h * b3, rate(theta + h * a3)
            theta += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
            omega += h / 6 * (b1 + 2 * b2 + 2 * b3 + b4)
        yield math.sin(theta), -math.cos(theta)


def say(test, setting, values):
    """One result as a line of JSON: the mean over phases, but the median over starts."""
    value = statistics.median(values) if test == "mass-ratio" else statistics.fmean(values)
    line = {"test": test, "setting": setting, "value": value, "samples": values}
    print(json.dumps(line), flush=True)


def main(make, well_set, extra):
    """Every test as the engine comes and well set, then what single options do.

    Args:
        well_set: test -> settings, in the engine's own words.
        extra: words -> (test, settings).
    """
    for test, measure in TESTS.items():
        say(test, "default", measure(make, {}))
        say(test, "tuned", measure(make, well_set.get(test, {})))
    for words, (test, settings) in extra.items():
        say(test, words, TESTS[test](make, settings))
