"""The diagnosis of ``collisions``: each wrong formula is recognised as itself, and its references hold."""

from __future__ import annotations

import importlib.util
import inspect
import math
from pathlib import Path

import numpy as np
import pytest

from course.physics.body import Body
from course.physics.contact import Surface
from course.physics.simulator import Simulator
from course.physics.state import RigidBodyState
from course.scoring import kit
from course.scoring.checks.collected import MARKERS

ROOT = Path(__file__).parents[3]
HERE = ROOT / "exercises" / "collisions"
bundles = kit.companion("collisions", "bundles")
probes, paths, engine, tracks = bundles.probes, bundles.paths, bundles.engine, bundles.tracks
formulas = kit.reference("collisions", "formulas")
motions = kit.reference("collisions", "motions")
draws = kit.reference("collisions", "draws")
report = kit.companion("collisions", "report")
GRADERS = ROOT / "tests" / "graders" / "collisions" / "checks.py"


def module(path):
    spec = importlib.util.spec_from_file_location(f"collisions_{path.parent.name}_{path.stem}", path)
    loaded = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(loaded)
    return loaded


SOLUTION = module(ROOT / "solutions" / "collisions" / "collisions.py")


@pytest.fixture(scope="module")
def checks(request):
    """Every check of the exercise, public ones first."""
    for marker in MARKERS:
        request.config.addinivalue_line("markers", marker)
    files = [module(HERE / "checks.py"), module(GRADERS)]
    return {name: check for file in files for name, check in vars(file).items() if name.startswith("test_")}


class Fake:
    """A submission that consists of the functions of a module, or of any others."""

    def __init__(self, functions):
        self._functions = functions

    def call(self, name, *args):
        return self._functions[name](*args)

    def call_each(self, name, calls):
        return [self.call(name, *args) for args in calls]

    def call_inspect(self, name, *args):
        return kit.Inspected(self.call(name, *args), list(args), shared=False)


def scenes(task, seed=0):
    """Arguments of many kinds for a task, none of them degenerate."""
    rng = np.random.default_rng(seed)
    make = {
        "detect_sphere_sphere": lambda s: draws.spheres(rng, 3, s),
        "detect_sphere_plane": lambda s: draws.plane(rng, 3, s - 1.0),
        "impulse_1d": lambda s: draws.line(rng),
        "resolve": lambda s: draws.impact(rng, 3),
        "resolve_with_friction": lambda s: draws.friction(rng, 3, s),
    }
    if task == "time_of_impact":
        some = [draws.passing(rng, 3, share) for share in (0.3, 0.7, 0.9, 1.2, 1.8)]
        some += [draws.shot(rng, 1e3), draws.overlap(rng, True), draws.overlap(rng, False)]
        far = draws.passing(rng, 3, 0.5)
        near = draws.passing(rng, 3, 0.05)
        xa, va, ra, xb, vb, *rest = near
        places = (np.array(a, dtype=float) for a in ([-5, 0, 0], [2, 0, 0], [5, 0, 0], [-2, 0, 0]))
        first, fast, second, back = places
        some.append((first, fast, 0.5, second, back, 0.4, 4.0))
        return [*some, (*far[:6], 0.1 * far[6]), near, (xa, vb, ra, xb, va, *rest)]  # the last one parts
    calls = [make[task](share) for share in (0.3, 0.8, 1.3, 2.0, 4.0)]
    if task in ("impulse_1d", "resolve", "resolve_with_friction"):
        ma, mb, va, vb, *rest = calls[0]
        calls.append((ma, mb, vb, va, *rest))  # one that separates
    return calls


def path(scene, t):
    """Where a head-on pair must be at times t."""
    truth = motions.meeting(scene)
    return scene.at(t, truth.contact, truth.after)


def said(task, calls, values):
    """The code that the probe of single calls gives."""
    found = probes.of_calls(task, calls, values, [formulas.RIGHT[task](*call) for call in calls])
    return found and found.code


@pytest.mark.parametrize("task", formulas.RIGHT)
def test_the_right_formula_is_given_no_code(task):
    calls = scenes(task)
    assert said(task, calls, [formulas.RIGHT[task](*call) for call in calls]) is None


@pytest.mark.parametrize("e", [1.0, 0.6, 0.0])
def test_the_head_on_path_is_that_of_the_course_s_own_simulator(e):
    scene = paths.HeadOn((1.0, 2.5), (-3.0, 2.0), (2.0, -1.0), 0.4, e)
    balls = [
        Body.sphere(m, scene.radius, RigidBodyState.of([x, 0, 0], [v, 0, 0]))
        for m, x, v in zip(scene.m, scene.x0, scene.v0, strict=True)
    ]
    run = Simulator(balls, h=0.01, gravity=0.0, ground=None, surface=Surface(restitution=e)).run(3.0)
    x, _ = path(scene, run.t)
    assert run.position[:, :, 0] == pytest.approx(x, abs=1e-9)


def test_each_hop_of_the_drop_keeps_e_squared_of_the_height_and_the_last_one_ends():
    scene = paths.Drop(1.0, 0.0, 0.1, 0.7)
    times, speeds = map(np.array, motions.contacts(scene, 10.0, 0.1))
    assert speeds[:-1] ** 2 / (2 * 9.81) == pytest.approx(0.9 * 0.49 ** np.arange(1, len(speeds)))
    assert speeds[-2] > 0.1
    assert speeds[-1] == 0.0
    z, v = scene.at([9.0, 10.0], times, speeds)
    assert z == pytest.approx(0.1)
    assert not v.any()


@pytest.mark.parametrize("seed", range(20))
def test_pymunk_is_as_far_off_as_is_said_and_no_further(seed):
    rng = np.random.default_rng(seed)
    h, n = float(rng.uniform(0.003, 0.01)), 200
    scene = draws.head_on(rng, "meet")
    truth = motions.meeting(scene)
    x, _ = path(scene, h * np.arange(n + 1))
    off = np.abs(engine.head_on(scene, n * h, h) - x)
    assert np.all(off <= engine.head_on_error(scene, truth.after, h))
    late = math.ceil(truth.contact / h) * h - truth.contact
    change = np.abs(np.subtract(truth.after, scene.v0))
    assert off[-1] == pytest.approx(change * late, abs=engine.ROUNDING)
    scene = paths.Drop(
        float(rng.uniform(0.5, 2.0)), float(rng.uniform(-1, 1)), 0.1, float(rng.uniform(0.3, 1.0))
    )
    times, speeds = motions.contacts(scene, 100.0, 1e-3)
    n = int((times[0] + 1.9 * speeds[0] / scene.g) / h)  # until shortly before the second contact
    z, _ = scene.at(h * np.arange(n + 1), times, speeds)
    assert np.max(np.abs(engine.drop(scene, n * h, h)[:, 0] - z)) <= engine.drop_error(scene, h)


def test_a_pair_that_parts_and_is_struck_all_the_same_is_recognised():
    scene = paths.HeadOn((1.0, 2.0), (-1.0, 1.0), (-1.0, 1.0), 0.5, 0.5)
    t = 0.1 * np.arange(11)
    x, v = scene.at(t, 0.55, (-0.5, 0.5))
    assert tracks.of_head_on(scene, motions.meeting(scene), t, x, v, 0.1).code == "IMPULSE_ON_SEPARATING"


def head_on_code(change):
    """What ``tracks`` says of a right path after ``change(t, x, v, meeting)``."""
    scene = paths.HeadOn((1.0, 2.0), (-1.0, 1.07), (1.0, -0.9), 0.5, 0.5)
    t, meeting = 0.1 * np.arange(21), motions.meeting(scene)
    x, v = (array.copy() for array in path(scene, t))
    found = tracks.of_head_on(scene, meeting, t, *change(t, x, v, meeting), 0.1)
    return found and found.code


def test_what_the_first_of_several_impacts_does_decides():
    """Impulses of half the size come again at every step, until nothing is left of the approach."""

    def halved(t, x, v, meeting):
        left = 0.25 ** np.maximum(0, np.ceil((t - meeting.contact) / 0.1)[:, None])
        mean = (v[0, 0] + 2 * v[0, 1]) / 3
        return x + 0.01 * (left < 1), mean + left * (v[0] - mean)

    assert head_on_code(halved) not in ("RESTITUTION_IGNORED", "ONLY_THE_REBOUND")


@pytest.mark.parametrize(("height", "code"), [(0.13, "RESTS_ELSEWHERE"), (0.0, "RESTS_ELSEWHERE")])
def test_a_ball_that_rests_elsewhere_does_not_jitter(height, code):
    scene, h = paths.Drop(0.5, 0.0, 0.1, 0.3), 0.02
    truth = motions.bounces(scene, 2.0 + h, h)
    t = h * np.arange(101)
    z, v = (array.copy() for array in scene.at(t, truth.times, truth.speeds))
    z[t > truth.may] = height
    assert tracks.of_drop(scene, truth, t, z, v, h).code == code


def test_a_pair_that_is_struck_again_and_again_is_recognised():
    scene = paths.HeadOn((1.0, 2.0), (-1.0, 1.0), (1.0, -1.0), 0.5, 0.5)
    t = 0.1 * np.arange(21)
    x, v = (array.copy() for array in path(scene, t))
    v[12:] = v[12:, ::-1] / 3
    v[15:] = v[15:, ::-1] / 2
    assert tracks.of_head_on(scene, motions.meeting(scene), t, x + 0.01, v, 0.1).code == "INITIAL_STATE_WRONG"
    x[12:] += 0.1
    assert tracks.of_head_on(scene, motions.meeting(scene), t, x, v, 0.1).code == "IMPULSE_ON_SEPARATING"


GARBAGE = [
    None,
    "two",
    3.5,
    math.nan,
    10**400,
    [],
    [[], [], []],
    [True, None],
    {"a": 1},
    [math.nan, [math.nan] * 3, math.inf],
    [np.full(3, np.nan), np.full(3, np.inf)],
    [np.full(3, 1e308), np.full(3, -1e308)],
    [[1.0, [2.0]], [3.0]],
    np.zeros((2, 2, 2)),
    [True, np.zeros(3), 0.0],
    [np.array([]), np.array([]), np.array([])],
]


@pytest.mark.parametrize("value", GARBAGE, ids=repr)
def test_whatever_a_submission_returns_each_check_ends_in_a_finding(checks, value):
    submission = Fake(dict.fromkeys(formulas.RIGHT | dict.fromkeys((bundles.HEAD_ON, bundles.DROP)), None))
    submission.call = lambda name, *args: value
    assert len(checks) == 51
    for name, check in checks.items():
        if not name.endswith("arguments"):  # those look at the arguments alone, and give no points
            with pytest.raises(kit.CheckFailed):
                run(check, submission)


def run(check, submission):
    """One check, with a generator if it draws its scenes."""
    wanted = inspect.signature(check).parameters
    rng = {"rng": np.random.default_rng(1)} if "rng" in wanted else {}
    check(submission, **rng, **({"draw": None} if "draw" in wanted else {}))


@pytest.mark.parametrize("spoil", [math.nan, math.inf, 1e308, -1e308])
def test_simulations_that_blow_up_end_in_a_finding(checks, spoil):
    functions = {name: getattr(SOLUTION, name) for name in (bundles.HEAD_ON, bundles.DROP)}

    def blown(name, *args):
        t, x, v = functions[name](*args)
        x[len(t) // 2 :], v[len(t) // 2 :] = spoil, spoil
        return t, x, v

    submission = Fake(functions)
    submission.call = blown
    for name, check in checks.items():
        if name.startswith(("test_head_on", "test_drop")) and not name.endswith("arguments"):
            with pytest.raises(kit.CheckFailed):
                run(check, submission)


def test_the_report_predicts_pymunk_s_difference_to_the_digit():
    shown = report.report(Fake(vars(SOLUTION)))
    assert len(shown.sections) == 4
    assert all(section.plot for section in shown.sections)
    for row in shown.sections[2].rows:
        assert row[2] == row[3]


def test_the_report_describes_the_differences_that_are_drawn():
    def late(name, *args):
        t, x, v = getattr(SOLUTION, name)(*args)
        return t, x + 0.25, v

    submission = Fake({})
    submission.call = late
    for shown, wrong in ((report.report(Fake(vars(SOLUTION))), False), (report.report(submission), True)):
        head_on, drop = (section.plot.description for section in shown.sections[2:])
        assert ("at most 0.00 mm up to the contact" in head_on) is not wrong
        assert ("at most 250.00 mm up to the contact" in head_on) is wrong
        assert ("ms: -2" in drop) is wrong


def test_the_report_draws_the_program_that_is_still_to_be_mended():
    stub = module(HERE / "collisions.py")

    def missing(name, *args):
        if name != bundles.HEAD_ON:
            raise kit.StudentFailure("error", type="NotImplementedError", message="")
        return stub.simulate_head_on(*args)

    submission = Fake({})
    submission.call = missing
    first, second, *_ = report.report(submission).sections
    assert first.rows[0][1] == "5.000000 m"  # the left ball ends where the right one began
    assert "not written yet" in second.text


def test_contacts_that_are_missed_beside_exact_ones_are_not_laid_to_a_search():
    calls = [draws.passing(np.random.default_rng(seed), 3, 0.3) for seed in range(4)]
    truth = [formulas.RIGHT["time_of_impact"](*call) for call in calls]
    assert said("time_of_impact", calls, [None, *truth[1:]]) == "CONTACTS_MISSED"
    early = [t - 1e-3 for t in truth]
    assert said("time_of_impact", calls, [None, *early[1:]]) == "CONTACTS_MISSED"


def test_a_number_for_a_miss_is_not_a_contact_in_the_past():
    calls = scenes("time_of_impact")
    truth = [formulas.RIGHT["time_of_impact"](*call) for call in calls]
    for number in (-1.0, 0.0, math.inf):
        values = [number if right is None else right for right in truth]
        assert said("time_of_impact", calls, values) == "MISS_IS_A_NUMBER"


def test_friction_where_none_belongs_is_too_strong_and_not_askew():
    call = (1.0, 2.0, *map(np.array, ([3.0, 1.0, 0.0], [0.0, 0.0, 2.0], [1.0, 0.0, 0.0])), 0.5, 0.0)
    value = formulas.RIGHT["resolve_with_friction"](*call[:-1], 0.1)
    assert said("resolve_with_friction", [call], [value]) == "FRICTION_TOO_STRONG"
    turned = value[0], value[1] + np.array([0.0, 0.1, 0.3])
    assert (
        probes._rubs([call], [turned], [formulas.RIGHT["resolve_with_friction"](*call)]) == "FRICTION_ASKEW"
    )


def test_walls_are_called_smooth_only_if_all_are():
    rng = np.random.default_rng(1)
    calls = [draws.wall(draws.friction(rng, 3, 0.6), side) for side in (0, 1)]
    truth = [formulas.RIGHT["resolve_with_friction"](*call) for call in calls]
    smooth = [formulas.RIGHT["resolve"](*call[:-1]) for call in calls]
    assert said("resolve_with_friction", calls, smooth) == "WALLS_SMOOTH"
    assert said("resolve_with_friction", calls, [smooth[0], truth[1]]) != "WALLS_SMOOTH"


def test_of_nan_only_its_place_is_told():
    rng = np.random.default_rng(2)
    apart = draws.spheres(rng, 3, 0.8)
    nan = (True, np.full(3, np.nan), 0.1)
    assert said("detect_sphere_sphere", [apart], [nan]) != "NORMAL_UNDEFINED"
    sliding = draws.friction(rng, 3, 0.6)
    spoilt = np.full(3, np.nan), np.full(3, np.nan)
    assert said("resolve_with_friction", [sliding], [spoilt]) != "NO_SLIDING_NAN"
    meets = draws.passing(rng, 3, 0.5)
    xa, va, ra, xb, vb, rb, dt = meets
    parting, passing = (xa, vb, ra, xb, va, rb, dt), draws.passing(rng, 3, 1.6)
    assert said("time_of_impact", [parting], [math.nan]) == "MISS_IS_A_NUMBER"
    assert said("time_of_impact", [passing], [math.nan]) == "ROOT_OF_A_NEGATIVE"


def test_an_overlap_is_no_miss():
    parting = draws.overlap(np.random.default_rng(3), False)
    assert said("time_of_impact", [parting], [0.0]) == "OVERLAP_ALWAYS_HITS"
    assert said("time_of_impact", [parting], [parting[-1]]) is None


def head_on_path(h=0.05):
    scene = paths.HeadOn((1.0, 2.0), (-1.0, 0.93), (2.0, -1.5), 0.25, 0.5)
    t = h * np.arange(30)
    return scene, t, *path(scene, t)


def test_a_path_in_single_precision_is_told_so():
    scene, t, x, v = head_on_path()
    rough = (a.astype(np.float32).astype(float) for a in (x, v))
    assert tracks.of_head_on(scene, motions.meeting(scene), t, *rough, 0.05).code == "PRECISION_LOST"
    rough = np.float32(0.01) * np.arange(200)
    assert tracks.of_times(rough.astype(float), 0.01).code == "PRECISION_LOST"


def test_a_ball_that_loses_nothing_does_not_tell_a_wrong_time_from_another_floor():
    for e, code in ((1.0, None), (0.7, "TIME_LEFT_WRONG")):
        scene, h = paths.Drop(1.0, 0.0, 0.1, e), 0.01
        truth = motions.bounces(scene, 1.0, h)
        t = h * np.arange(90)
        # From the first contact on it is a millisecond ahead.
        z, v = (
            np.where(t < truth.times[0], *both)
            for both in zip(
                scene.at(t, truth.times, truth.speeds),
                scene.at(t + 1e-3, truth.times, truth.speeds),
                strict=True,
            )
        )
        found = tracks.of_drop(scene, truth, t, z, v, h)
        assert (found and found.code) == code


def test_velocities_that_count_downwards_are_told_from_a_wrong_flight():
    scene, h = paths.Drop(1.0, 0.0, 0.1, 0.7), 0.01
    truth = motions.bounces(scene, 1.0, h)
    t = h * np.arange(90)
    z, v = scene.at(t, truth.times, truth.speeds)
    assert tracks.of_drop(scene, truth, t, z, -v, h).code == "VELOCITIES_APART"
    assert tracks.of_drop(scene, truth, t, z + 1e-3 * np.sin(t), v, h).code == "FLIGHT_WRONG"
    # It slides along the floor, and gravity goes on.
    sliding = np.maximum(scene.z0 - scene.g * t**2 / 2, scene.radius), -scene.g * t
    elastic = paths.Drop(1.0, 0.0, 0.1, 1.0)
    found = tracks.of_drop(elastic, motions.bounces(elastic, 1.0, h), t, *sliding, h)
    assert found is None or found.code != "SPEED_AT_STEP_END"


def test_a_ball_that_settles_at_once_would_still_fly_by_a_rule_that_is_not_that_of_g_h():
    rng = np.random.default_rng(5)
    for _ in range(50):
        scene, t_end, h = draws.settling_at_once(rng)
        n, slowest = round(t_end / h), scene.g * h
        assert t_end / h > n
        assert motions.bounces(scene, t_end, h).speeds == (0.0,)
        # By g times the rest of the step it would rest at its third contact or later, and has to rest before.
        for contact in (1, 3):
            rest = math.ceil(contact * scene.fastest / slowest) - contact * scene.fastest / slowest
            assert scene.fastest > slowest * rest
        assert motions.bounces(scene, t_end, h).must < 5 * scene.fastest / scene.g


@pytest.mark.parametrize("factor", [0.5, 1.0, 2.0, 3.0])
def test_a_fall_that_gains_another_share_of_its_height_is_told_by_the_rebound(factor):
    scene, h = paths.Drop(1.0, 0.0, 0.1, 0.7), 0.01
    z, v, g, low = 1.0, 0.0, scene.g, 0.1
    rows = [(z, v)]
    while len(rows) < 60:
        z_next, v_next = z + v * h - g * h * h / 2, v - g * h
        if z_next < low:
            speed = math.sqrt(v * v + factor * g * (z - low))
            up, left = 0.7 * speed, h - (v + speed) / g
            z_next, v_next = low + up * left - g * left * left / 2, up - g * left
        z, v = z_next, v_next
        rows.append((z, v))
    path = np.array(rows).T
    found = tracks.of_drop(scene, motions.bounces(scene, 1.0, h), h * np.arange(60), *path, h)
    code = found and found.code
    # Three times is no slip that is known.
    assert (code == "FALL_WITHOUT_TWO") == (factor in (0.5, 1.0)), code


@pytest.mark.parametrize(
    ("floor", "code"),
    [(0.0, "RADIUS_IGNORED"), (0.05, "RADII_HALVED"), (0.2, "FLOOR_TOO_HIGH"), (0.07, None)],
)
def test_a_floor_at_another_height_is_told_however_the_ball_comes_to_rest_there(floor, code):
    scene, other, h = paths.Drop(1.0, 0.0, 0.1, 0.7), paths.Drop(1.0, 0.0, floor, 0.7), 0.01
    t = h * np.arange(90)
    theirs = motions.bounces(other, 1.0, h)
    path = other.at(t, theirs.times, theirs.speeds)
    found = tracks.of_drop(scene, motions.bounces(scene, 1.0, h), t, *path, h)
    assert (found and found.code) == code


def dropped(e, speed_of, h=0.02, often=True):
    """What ``tracks`` says of a ball that rests by its speed before the contact.

    ``often``: it bounces as often as it is back within the step; ``speed_of``: the speed that counts for a
    bounce, of that at the floor and that at the start of the step.
    """
    scene = paths.Drop(0.6, -0.3, 0.1, e)
    z, v, rests = scene.z0, scene.v0, False
    rows = [(z, v)]
    for _ in range(80):
        left, start, bounced = h, v, False
        while not rests:
            fallen = z + v * left - scene.g * left**2 / 2
            if fallen > scene.radius or (bounced and not often):
                z, v = fallen, v - scene.g * left
                break
            speed = math.sqrt(max(v**2 + 2 * scene.g * (z - scene.radius), 0.0))
            left -= (v + speed) / scene.g
            rests = speed <= scene.g * h
            z, v, bounced = scene.radius, e * speed_of(speed, abs(start)), True
        z, v = (scene.radius, 0.0) if rests else (z, v)
        rows.append((z, v))
    t = h * np.arange(len(rows))
    found = tracks.of_drop(scene, motions.bounces(scene, t[-1] + h, h), t, *np.array(rows).T, h)
    return found and found.code


def test_a_ball_that_bounces_once_a_step_and_one_that_leaves_with_an_old_speed_are_told():
    assert dropped(0.0, lambda speed, old: speed, often=False) == "ONE_BOUNCE_A_STEP"
    assert dropped(0.005, lambda speed, old: speed, often=False) == "ONE_BOUNCE_A_STEP"
    assert dropped(0.7, lambda speed, old: old) == "SPEED_AT_STEP_START"


def test_friction_along_the_slip_is_not_friction_that_is_too_weak():
    calls = scenes("resolve_with_friction")
    right = [formulas.RIGHT["resolve_with_friction"](*call) for call in calls]
    smooth = [formulas.RIGHT["resolve_with_friction"](*call[:6], 0.0) for call in calls]
    for share, code in ((-0.4, "FRICTION_DRIVES"), (0.4, "FRICTION_TOO_WEAK")):
        values = [
            tuple(s + share * (r - s) for s, r in zip(*pair, strict=True))
            for pair in zip(smooth, right, strict=True)
        ]
        assert said("resolve_with_friction", calls, values) == code


def test_energy_and_momentum_are_said_of_the_first_wrong_pair_alone():
    n = np.array([1.0])
    slow, fast = [(1.0, 2.0, np.array([v]), np.array([0.0]), n, 0.5) for v in (1.0, 4.0)]
    truth = [formulas.RIGHT["resolve"](*call) for call in (slow, fast)]
    weaker = truth[0][0], truth[0][1] - 0.1  # loses energy, and momentum
    created = truth[1][0] - 9.0, truth[1][1] + 4.5
    for first, second, code in ((weaker, created, "MOMENTUM_LOST"), (created, weaker, "ENERGY_CREATED")):
        calls, right = ([slow, fast], truth) if code == "MOMENTUM_LOST" else ([fast, slow], truth[::-1])
        assert probes._by_law("resolve", calls, [first, second], right) == code


def test_no_tolerance_is_explained_by_what_a_student_cannot_see():
    sources = bundles.ROUNDING + bundles.INSTANT
    assert not [word for word in ("solutions", "contract", "benchmarks") if word in sources]


def test_a_ball_that_falls_on_while_it_lies_on_the_floor_loses_points():
    """It had full marks where the velocity of a last hop is free: one impact a step, then free fall."""
    scene, t_end, h = draws.twice_in_a_step(np.random.default_rng(3))
    (truth,) = bundles.bounces([(scene, t_end, h)])
    t = h * np.arange(round(t_end / h) + 1)
    z, v = scene.at(t, truth.times, truth.speeds)
    bundles.expect_drop(scene, truth, (t, z, v), t_end, h, "wrong")
    with pytest.raises(kit.CheckFailed):
        bundles.expect_drop(scene, truth, (t, z, np.where(t == t[2], -0.1, v)), t_end, h, "wrong")
