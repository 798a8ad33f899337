"""Hidden graders of ``digital-twin``. Parameters are drawn anew from the seed of each grading run.

Thresholds come from sweeps over seeds of every accepted solution; the table is in
``tests/benchmarks/calibration/digital-twin.md``.
"""

from __future__ import annotations

import numpy as np
import pytest

from course.grading import kit

bundles = kit.companion("digital-twin", "bundles")
scenes = kit.companion("digital-twin", "scenes")
actuators, sensors, twins = bundles.actuators, bundles.sensors, bundles.twins
loops = kit.sibling(__file__, "loops")
parts = kit.sibling(__file__, "parts")
rays = kit.sibling(__file__, "rays")

# -- encoder --------------------------------------------------------------------------------------------


@pytest.mark.task("encoder")
@pytest.mark.points(3)
def test_encoder_turns(submission, rng):
    """An encoder of another resolution counts over many turns both ways"""
    per_turn = int(rng.integers(7, 500))
    theta = rng.uniform(-60.0, 60.0, 600)
    bundles.expect_counts(submission.call("encoder", theta, per_turn), theta, per_turn)


@pytest.mark.task("encoder")
@pytest.mark.points(2)
def test_encoder_inputs(submission, rng):
    """The encoder leaves its angles alone, over a few turns and both ways"""
    theta = rng.uniform(-9.0, 9.0, 300)
    value = bundles.expect_clean(submission, "encoder", (theta, 48), ("theta", None))
    bundles.expect_counts(value, theta, 48)


# -- gyroscope ------------------------------------------------------------------------------------------


@pytest.mark.task("imu")
@pytest.mark.points(3)
def test_imu_walk(submission, rng):
    """Over one sample and over ten, the bias wanders as the root of time"""
    n, dt, walk = 20000, rng.uniform(0.004, 0.05), 0.01 * rng.uniform(0.5, 2.0)
    calls = [(np.zeros(n), dt, 0.0, walk, float(rng.normal()), rng)]
    ((_, bias),) = bundles.imu_pairs(submission, calls)
    for m in (1, 10):
        with np.errstate(all="ignore"):
            spread = bundles.std(bias[m:] - bias[:-m]) ** 2
        kit.expect_close(
            spread,
            walk**2 * m * dt,
            rel=0.15,
            source="the variance over ten of 20000 samples scatters by 2.6 %",
            quantity=f"variance of the bias over {m} samples",
            units="(rad/s)²",
            input={"dt": dt, "bias_random_walk": walk, "noise_density": 0.0, "samples": n},
            message="The bias does not wander as a random walk of its strength does.",
            help="Independent steps add up: the variance grows with the time between two samples.",
            diagnose=lambda: sensors.of_imu(submission, bias_first=True),
        )


@pytest.mark.task("imu")
@pytest.mark.points(2)
def test_imu_randomness(submission, rng):
    """Noise and bias are independent, and the generator that is passed in decides about both"""
    parts.expect_randomness(submission, rng)


@pytest.mark.task("imu")
@pytest.mark.points(2)
def test_imu_inputs(submission, rng):
    """The true rate is left alone, and is in the measured one unchanged"""
    true, dt = 3.0 * np.sin(np.linspace(0, rng.uniform(5, 9), 50)), rng.uniform(0.01, 0.1)
    call = (true, dt, 0.0, 0.02, 0.1, rng)
    value = bundles.expect_clean(submission, "imu", call, ("true", *[None] * 5))
    measured, bias = kit.as_tuple(value, ("measured", "bias"))
    kit.expect_array(
        kit.as_vector(measured, 50, "measured") - kit.as_vector(bias, 50, "bias"),
        true,
        abs=1e-9,
        source="rounding",
        quantity="measured - bias",
        units="rad/s",
        message="Without white noise, measured minus bias is not the true rate.",
        help="measured[k] = true[k] + bias[k] + white noise.",
        input={"true": true, "dt": dt},
        diagnose=lambda: sensors.of_imu(submission, bias_first=True),
    )


# -- fit_noise ------------------------------------------------------------------------------------------


@pytest.mark.task("fit_noise")
@pytest.mark.points(5)
def test_fit_noise_unknown(submission, rng):
    """Gyroscopes of other kinds and other sampling rates are identified from their recordings"""
    cases = []
    for _ in range(12):
        density, dt = 10 ** rng.uniform(-3.5, -2.0), rng.uniform(0.005, 0.03)
        # The walk takes over after some 60 to 120 samples: both are to be seen in one recording.
        walk = density / (dt * rng.uniform(60, 120))
        bias0 = float(rng.normal()) * 30 * density
        still = scenes.recording(rng, 12000, dt, density, walk, bias0)
        cases.append((still, dt, density, walk, bias0))
    bundles.expect_fits(submission, cases, (0.03, 0.38, 2.1))


@pytest.mark.task("fit_noise")
@pytest.mark.points(1)
def test_fit_noise_inputs(submission, rng):
    """fit_noise leaves its recording alone"""
    still = scenes.recording(rng, 2000, 0.02, 0.002, 0.003, 0.5)
    value = bundles.expect_clean(submission, "fit_noise", (still, 0.02), ("still", None))
    found = kit.as_record(value, ("noise_density", "bias_random_walk", "bias0"))
    kit.expect_close(
        found["noise_density"],
        0.002,
        rel=0.2,
        source="2000 samples: the density scatters by 2 %",
        quantity="noise_density",
        units="rad/s/sqrt(Hz)",
        message="From a short recording, the noise density is wrong.",
        diagnose=lambda: sensors.of_density(found["noise_density"], still, 0.02, 0.002),
    )


# -- lidar ----------------------------------------------------------------------------------------------


@pytest.mark.task("lidar")
@pytest.mark.points(3)
def test_lidar_walls(submission, rng):
    """In a crooked hall with walls standing about, every beam finds its nearest wall or none"""
    parts.expect_hall(submission, rng)


@pytest.mark.task("lidar")
@pytest.mark.points(3)
def test_lidar_noise(submission, rng):
    """Hits have noise of std sigma, each its own, never below zero; beams without a hit read r_max exactly"""
    parts.expect_scan_noise(submission, rng)


@pytest.mark.task("lidar")
@pytest.mark.points(1)
def test_lidar_inputs(submission, rng):
    """The scanner leaves pose, walls and angles alone"""
    pose, walls = rng.uniform(-1, 1, 3), rays.hall(rng)
    angles = rng.uniform(-3, 3, 12)
    call = (pose, walls, angles, 5.0, 0.0, rng)
    value = bundles.expect_clean(submission, "lidar", call, ("pose", "segments", "angles", *[None] * 3))
    expected, clear = rays.distances(pose, walls, angles, 5.0)
    kit.expect_array(
        kit.as_vector(value, 12, "ranges")[clear],
        expected[clear],
        abs=1e-9,
        source="rounding",
        quantity="ranges",
        units="m",
        input={"pose": pose, "segments": walls, "angles": angles},
        message="A distance is wrong.",
        diagnose=lambda: sensors.of_lidar(submission),
    )


# -- motor ----------------------------------------------------------------------------------------------


@pytest.mark.task("motor_step")
@pytest.mark.points(4)
def test_motor_unknown(submission, rng):
    """An unknown motor follows commands large and small, both ways, at steps short and long"""
    tau, u_max, dead = rng.uniform(0.05, 1.0), rng.uniform(5, 20), rng.uniform(0.5, 1.5)
    commands = rng.permutation(
        [*rng.uniform(-1, 1, 6) * u_max, 2 * u_max, -3 * u_max, 0.5 * dead, -0.7 * dead, dead, -dead]
    )
    calls = [(float(u), tau * float(rng.choice([0.1, 0.7, 2.0, 5.0])), tau, u_max, dead) for u in commands]
    parts.expect_motor(submission, 0.3 * u_max, calls)


@pytest.mark.task("motor_step")
@pytest.mark.points(2)
def test_motor_overspeed(submission, rng):
    """A motor that spins faster than its command may be runs out gradually"""
    tau, u_max = rng.uniform(0.1, 1.0), rng.uniform(5, 20)
    calls = [(u, 0.3 * tau, tau, u_max, 0.5) for u in (u_max, 0.2, -2 * u_max)]
    parts.expect_motor(submission, rng.uniform(1.5, 3.0) * u_max, calls)


# -- backlash -------------------------------------------------------------------------------------------


@pytest.mark.task("backlash")
@pytest.mark.points(5)
def test_backlash_swings(submission, rng):
    """On swings of any speed the output is late by half the gap each way, and rests on small ones"""
    parts.expect_swings(submission, rng)


# -- delay ----------------------------------------------------------------------------------------------


@pytest.mark.task("delay_line")
@pytest.mark.points(3)
def test_delay_fractions(submission, rng):
    """Any latency, short or long, delays any signal by that much"""
    cases = []
    for samples in (rng.uniform(0.1, 0.9), rng.uniform(1.1, 6.9), rng.uniform(7.5, 15.5)):
        x, dt = rng.normal(1.0, 1.0, 30), rng.uniform(0.002, 0.5)
        cases.append((x, dt, samples * dt))
    for case, value in zip(cases, submission.call_each("delay_line", cases), strict=True):
        bundles.expect_delayed(value, *case, parts.delayed(*case))


@pytest.mark.task("delay_line")
@pytest.mark.points(2)
def test_delay_edges(submission, rng):
    """No latency, whole samples, more latency than signal; and the signal is left alone"""
    x, dt = rng.normal(2.0, 1.0, 12), rng.uniform(0.01, 0.1)
    cases = [(x, dt, 0.0), (x, dt, 3 * dt), (x, dt, 20.3 * dt)]
    for case, value in zip(cases, submission.call_each("delay_line", cases), strict=True):
        bundles.expect_delayed(value, *case, parts.delayed(*case))
    value = bundles.expect_clean(submission, "delay_line", (x, dt, 0.0), ("x", None, None))
    bundles.expect_delayed(value, x, dt, 0.0, x)


# -- differential drive ---------------------------------------------------------------------------------


@pytest.mark.task("diff_drive_step")
@pytest.mark.points(2)
def test_drive_tour(submission, rng):
    """After a tour of many arcs, some backwards and some turning round and round, the pose is right"""
    track = rng.uniform(0.2, 0.8)
    turns = rng.choice([-1, 1], 30) * rng.uniform(0.2, 1.5, 30)
    speeds, dts = rng.uniform(-0.8, 0.8, 30), rng.uniform(0.1, 2.0, 30)
    calls = [
        (float(v - w * track / 2), float(v + w * track / 2), track, float(dt))
        for v, w, dt in zip(speeds, np.abs(turns) if rng.uniform() < 0.5 else turns, dts, strict=True)
    ]
    pose = rng.uniform(-3, 3, 3)
    folded = submission.fold("diff_drive_step", pose, calls)
    for value, call in zip(folded[1:], calls, strict=True):
        start, pose = pose, bundles.arc_end(pose, *call)
        bundles.expect_pose(submission, value, start, call, pose, abs_=1e-8)


@pytest.mark.task("diff_drive_step")
@pytest.mark.points(3)
def test_drive_slow_turns(submission, rng):
    """As the turn rate goes to zero, the arc goes over into a straight line without a jump"""
    parts.expect_slow_turns(submission, rng)


@pytest.mark.task("diff_drive_step")
@pytest.mark.points(1)
def test_drive_inputs(submission, rng):
    """A step leaves the old pose alone"""
    pose, call = rng.uniform(1, 2, 3), (0.3, 0.5, 0.4, 1.0)
    value = bundles.expect_clean(submission, "diff_drive_step", (pose, *call), ("pose", *[None] * 4))
    bundles.expect_pose(submission, value, pose, call, bundles.arc_end(pose, *call))


# -- the twin -------------------------------------------------------------------------------------------


@pytest.mark.task("sync")
@pytest.mark.points(3)
def test_sync_late(submission, rng):
    """A twin keeps up although a third of the measurements come late"""
    before, after = loops.friction_jump(rng)
    drive = before * rng.uniform(0.8, 1.2)
    cart = scenes.Cart(((0.0, before), (5.0, after)), v=drive / before)
    calls, truth = scenes.measured(cart, drive, 0.1 * np.arange(1, 241), rng, late=0.33, sigma=loops.QUIET)
    twin = scenes.new_twin(before, drive, speed=drive / before, sigma=loops.QUIET)
    bundles.expect_follows(
        submission,
        twin,
        calls,
        truth,
        settled=((2.0, 5.0), (9.0, 24.0)),
        frictions=((14.0, 24.0, after),),
        message="With measurements that come late and out of order, the twin does not stay with its cart.",
    )


@pytest.mark.task("sync")
@pytest.mark.points(3)
def test_sync_closes_loop(submission, rng):
    """A cart that is driven by what the twin has learned gets back to its speed after the friction jumped"""
    speed, target, found, friction = loops.through_sync(submission, rng)
    given = {"target": target, "friction at the end": friction}
    ask = lambda: twins.of_sync(submission, late=False)  # noqa: E731
    kit.expect_close(
        speed,
        target,
        rel=0.1,
        source=bundles.CALIBRATED,
        quantity="speed of the cart at the end",
        units="m/s",
        input=given,
        message="A cart whose drive comes from the twin's friction does not get back to its speed.",
        help="The drive changes from time to time: predict with the drive that the twin holds now.",
        diagnose=ask,
    )
    kit.expect_close(
        found,
        friction,
        rel=0.1,
        source=bundles.CALIBRATED,
        quantity="friction",
        units="1/s",
        input=given,
        message="In the loop, the twin does not find the friction.",
        diagnose=ask,
    )


@pytest.mark.task("sync")
@pytest.mark.points(2)
@pytest.mark.requires("sync_follows")  # a twin that never changes passes this one as well
def test_sync_repeats(submission, rng):
    """The same twin and the same measurement give the same result again, and the twin passed in is kept"""
    cart = scenes.Cart(((0.0, rng.uniform(0.4, 0.9)),), v=1.0)
    calls, _ = scenes.measured(cart, 0.5, 0.1 * np.arange(1, 31), rng, late=0.3)
    folded = submission.fold("sync", scenes.new_twin(0.6, 0.5, speed=1.0), calls)
    twins.states(folded)
    picks = [25, 3, 14, 3]
    again = submission.call_each("sync", [(folded[i], *calls[i]) for i in picks])
    kit.expect_true(
        all(twins.same(value, folded[i + 1]) for value, i in zip(again, picks, strict=True)),
        "Given an earlier twin and its measurement once more, sync returns another twin than the first time.",
        help='Everything that sync remembers has to be in twin["memory"].',
        diagnose=diagnosis_of("GLOBAL_MEMORY"),
    )
    names = ("twin", None, None)
    value = bundles.expect_clean(submission, "sync", (folded[20], *calls[20]), names)
    twins.states([value])


def diagnosis_of(code):
    """The finding's diagnosis where the check itself is the experiment."""
    return bundles.diagnosis.named(code)


@pytest.mark.task("command")
@pytest.mark.points(2)
def test_command_unknown(submission, rng):
    """For other frictions and speeds, forwards and backwards, the drive balances the friction"""
    cases = [(float(rng.uniform(0.1, 2.0)), float(rng.uniform(-2.0, 2.0))) for _ in range(8)]
    bundles.expect_drives(submission, cases)


@pytest.mark.task("command")
@pytest.mark.points(3)
def test_command_closes_loop(submission, rng):
    """Driven by command, a cart whose friction jumps gets to its speed and back to it"""
    speed, target, drives = loops.through_command(submission, rng)
    kit.expect_close(
        speed,
        target,
        rel=0.08,
        source=bundles.CALIBRATED,
        quantity="speed of the cart at the end",
        units="m/s",
        input={"target": target, "drives": drives},
        message="A cart that is driven by command does not hold its speed after its friction has changed.",
        help="The drive comes from the friction that the twin has learned and from the speed asked for.",
        diagnose=lambda: twins.of_command(submission),
    )
