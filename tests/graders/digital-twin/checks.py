"""Hidden graders of ``digital-twin``. Parameters are drawn anew from the seed of each grading run.

Thresholds come from sweeps over seeds of every accepted solution; the table is in
``tests/benchmarks/calibration/digital-twin.md``.
"""

from __future__ import annotations

import numpy as np
import pytest

from course.scoring import kit

actuators = kit.companion("digital-twin", "actuator_bundles")
bundles = kit.companion("digital-twin", "bundles")
scenes = kit.companion("digital-twin", "scenes")
sensors = kit.companion("digital-twin", "sensor_bundles")
twins = kit.companion("digital-twin", "twin_bundles")
parts = kit.sibling(__file__, "parts")
rays = kit.sibling(__file__, "rays")

# -- encoder --------------------------------------------------------------------------------------------


@pytest.mark.task("encoder")
@pytest.mark.points(3)
def test_encoder_turns(submission, rng):
    """encoder of another resolution, over many turns both ways"""
    per_turn = int(rng.integers(7, 500))
    theta = sensors.angles_between_counts(rng, 600, 10 * per_turn, per_turn)
    # More counts than sixteen bits hold, and angles that single precision does not tell apart.
    theta = np.append(theta, sensors.angles_beside_counts(rng.uniform(-1e5, 1e5, 40), per_turn))
    sensors.expect_counts(submission, submission.call("encoder", theta, per_turn), theta, per_turn)
    # The same angles on a finer encoder: on it none of these is near to a whole count or a half either.
    theta = sensors.angles_beside_counts(rng.uniform(-900, 900, 9), per_turn)
    calls = [(theta, per_turn), (theta, 3 * per_turn)]
    for (_, turn), counts in zip(calls, submission.call_each("encoder", calls), strict=True):
        sensors.expect_counts(submission, counts, theta, turn)


@pytest.mark.task("encoder")
@pytest.mark.points(2)
def test_encoder_inputs(submission, rng):
    """encoder over a few turns, both ways: the counts, and its argument"""
    theta = sensors.angles_between_counts(rng, 300, 70, 48)
    value = bundles.expect_clean(submission, "encoder", (theta, 48), ("theta", None))
    sensors.expect_counts(submission, value, theta, 48)


# -- gyroscope ------------------------------------------------------------------------------------------


@pytest.mark.task("imu")
@pytest.mark.points(2)
def test_imu_white(submission, rng):
    """imu at other densities and sampling rates: the strength of the white noise"""
    calls = [
        (np.zeros(20000), dt, 10 ** rng.uniform(-3.5, -2.0), 0.0, float(rng.normal()), rng)
        for dt in (rng.uniform(0.002, 0.006), rng.uniform(0.05, 0.5))
    ]
    calls.append((*calls[0][:2], 3 * calls[0][2], *calls[0][3:]))  # at the same rate, another density
    sensors.expect_white(submission, calls, 0.04, "the README's")


@pytest.mark.task("imu")
@pytest.mark.points(2)
def test_imu_walk(submission, rng):
    """imu: how far the bias wanders over one sample and over ten"""
    dt, walk = rng.uniform(0.004, 0.05), 0.01 * rng.uniform(0.5, 2.0)
    bias0 = float(rng.normal())
    for rate, strength in ((dt, walk), (2 * dt, walk), (dt, 3 * walk)):
        sensors.expect_walk(submission, 20000, rate, strength, bias0, rng)


@pytest.mark.task("imu")
@pytest.mark.points(2)
def test_imu_randomness(submission, rng):
    """imu at another rate: the random numbers of noise and bias"""
    sensors.expect_gyroscope_draws(submission, int(rng.integers(2**32)), rng.uniform(0.004, 0.05))


@pytest.mark.task("imu")
@pytest.mark.points(1)
def test_imu_inputs(submission, rng):
    """imu with other rates: the true rate, as an argument and in the measured rate"""
    true, dt = 3.0 * np.sin(np.linspace(0, rng.uniform(5, 9), 50)), rng.uniform(0.01, 0.1)
    sensors.expect_rate_kept(submission, true, dt, -0.1, rng)


# -- fit_noise ------------------------------------------------------------------------------------------


@pytest.mark.task("fit_noise")
@pytest.mark.points(5)
def test_fit_noise_unknown(submission, rng):
    """fit_noise on gyroscopes of other kinds, at other sampling rates"""
    sensors.expect_fits(submission, sensors.recordings(rng, 12, lambda: sensors.unknown_gyroscope(rng)))


@pytest.mark.task("fit_noise")
@pytest.mark.points(1)
def test_fit_noise_inputs(submission, rng):
    """fit_noise: its numbers, and its argument"""
    still = scenes.recording(rng, 2000, 0.02, 0.002, 0.003, 0.5)
    for factor, dt in ((1.0, 0.02), (1.0, 0.08), (3.0, 0.02)):  # as long, at another rate, of another kind
        sensors.expect_density_of_short(submission, factor * still, dt, factor * 0.002 * (dt / 0.02) ** 0.5)


# -- lidar ----------------------------------------------------------------------------------------------


@pytest.mark.task("lidar")
@pytest.mark.points(3)
def test_lidar_walls(submission, rng):
    """lidar in a crooked hall with free-standing walls"""
    parts.expect_hall(submission, rng)


@pytest.mark.task("lidar")
@pytest.mark.points(3)
def test_lidar_noise(submission, rng):
    """lidar with noise in another scene: hits and other beams"""
    sensors.expect_scan_noise(submission, rng.uniform(6.0, 9.0), rng.uniform(0.02, 0.08), rng)
    sensors.expect_scan_draws(submission, int(rng.integers(2**32)))


@pytest.mark.task("lidar")
@pytest.mark.points(1)
def test_lidar_inputs(submission, rng):
    """lidar in another scene: the readings, and its arguments"""
    call = (rng.uniform(-1, 1, 3), rays.hall(rng), rng.uniform(-3, 3, 12), 5.0, 0.0, rng)
    value = bundles.expect_clean(submission, "lidar", call, ("pose", "segments", "angles", *[None] * 3))
    parts.expect_ranges(submission, value, *call[:4], "A distance is wrong.")


# -- motor ----------------------------------------------------------------------------------------------

_MOTOR = "The speed of an unknown motor is not what its command, limits and lag make of it."


@pytest.mark.task("motor_step")
@pytest.mark.points(4)
def test_motor_unknown(submission, rng):
    """motor_step of an unknown motor: commands large and small, both ways"""
    tau, u_max, dead = rng.uniform(0.05, 1.0), rng.uniform(5, 20), rng.uniform(0.5, 1.5)
    edges = [factor * dead for factor in (0.5, -0.7, 1.0, -1.0, 1.05, -1.05)]
    commands = rng.permutation([*rng.uniform(-1, 1, 6) * u_max, 2 * u_max, -3 * u_max, *edges])
    steps = tau * rng.permutation(np.resize([0.001, 0.01, 0.1, 0.7, 2.0, 5.0], len(commands)))
    calls = [(float(u), float(dt), tau, u_max, dead) for u, dt in zip(commands, steps, strict=True)]
    calls.append((2.0 * u_max, 0.7 * tau, tau, u_max, 1.5 * u_max))
    actuators.expect_motor(submission, 0.3 * u_max, calls, _MOTOR)
    first = 0.1 * u_max, 0.8 * u_max, 0.3 * tau, tau, 0.7 * u_max, dead
    actuators.expect_motors(
        submission, first, (0.2 * u_max, 0.6 * u_max, tau, 3 * tau, 0.6 * u_max, 0.9 * u_max)
    )


@pytest.mark.task("motor_step")
@pytest.mark.points(2)
def test_motor_overspeed(submission, rng):
    """motor_step from a speed above the largest command, either way"""
    tau, u_max = rng.uniform(0.1, 1.0), rng.uniform(5, 20)
    for sign in (1.0, -1.0):
        calls = [(sign * u, 0.3 * tau, tau, u_max, 0.5) for u in (u_max, 0.2, -2 * u_max)]
        actuators.expect_motor(submission, sign * rng.uniform(1.5, 3.0) * u_max, calls, _MOTOR)


# -- backlash -------------------------------------------------------------------------------------------


@pytest.mark.task("backlash")
@pytest.mark.points(5)
def test_backlash_swings(submission, rng):
    """backlash at any speed, with large swings and small ones"""
    parts.expect_swings(submission, rng)


# -- delay ----------------------------------------------------------------------------------------------


@pytest.mark.task("delay_line")
@pytest.mark.points(3)
def test_delay_fractions(submission, rng):
    """delay_line with latencies short and long"""
    cases = []
    for samples in (rng.uniform(0.1, 0.9), rng.uniform(1.1, 6.9), rng.uniform(7.5, 15.5)):
        x, dt = rng.normal(1.0, 1.0, 30), rng.uniform(0.002, 0.5)
        cases.append((x, dt, samples * dt))
    (x, dt, late), other = cases[1], rng.normal(1.0, 1.0, 30)
    parts.expect_delays(
        submission, [*cases, *bundles.one_by_one((x, dt, late), (other, 1.3 * dt, 1.17 * late))]
    )


@pytest.mark.task("delay_line")
@pytest.mark.points(2)
def test_delay_edges(submission, rng):
    """delay_line with no latency, whole samples, or more latency than signal: the output, and its argument"""
    x, dt = rng.normal(2.0, 1.0, 12), rng.uniform(0.01, 0.1)
    parts.expect_delays(
        submission,
        [(x, dt, 0.0), (x, dt, 3 * dt), (x, dt, 20.3 * dt), (np.rint(9 * x).astype(int), dt, 1.3 * dt)],
    )
    actuators.expect_new_signal(submission, x, dt)


# -- differential drive ---------------------------------------------------------------------------------


@pytest.mark.task("diff_drive_step")
@pytest.mark.points(2)
def test_drive_tour(submission, rng):
    """diff_drive_step on a tour of many arcs"""
    parts.expect_tour(submission, rng)


@pytest.mark.task("diff_drive_step")
@pytest.mark.points(3)
def test_drive_slow_turns(submission, rng):
    """diff_drive_step as the turn rate goes to zero"""
    actuators.expect_slow_turns(submission, rng)


@pytest.mark.task("diff_drive_step")
@pytest.mark.points(1)
def test_drive_inputs(submission, rng):
    """diff_drive_step: the new pose, and its argument"""
    pose, wheels = rng.uniform(1, 2, 3), (0.3, 0.5, 0.4, 1.0)
    value = bundles.expect_clean(submission, "diff_drive_step", (pose, *wheels), ("pose", *[None] * 4))
    actuators.expect_pose(submission, value, pose, wheels)


# -- the twin -------------------------------------------------------------------------------------------


@pytest.mark.task("sync")
@pytest.mark.points(2)
def test_sync_late(submission, rng):
    """sync both ways, with a third of the measurements late"""
    message = "With some measurements late, the twin's position is further off than the README allows."
    for sign in (1.0, -1.0):
        twins.expect_keeps_up(submission, rng, sign=sign, late=0.33, message=message)


@pytest.mark.task("sync")
@pytest.mark.points(1)
def test_sync_driven(submission, rng):
    """sync with a drive that changes every second or so, and a third of the measurements late"""
    twins.expect_follows_drives(submission, rng)


@pytest.mark.task("sync")
@pytest.mark.points(3)
def test_sync_closes_loop(submission, rng):
    """sync in a loop after a jump in friction: the speed of the cart"""
    twins.expect_sync_closes_loop(submission, rng)


@pytest.mark.task("sync")
@pytest.mark.points(2)
@pytest.mark.requires("sync_follows")  # a twin that never changes passes this one as well
def test_sync_repeats(submission, rng):
    """sync called twice: its result, and its arguments"""
    twins.expect_twin_contract(submission, rng)


@pytest.mark.task("command")
@pytest.mark.points(2)
def test_command_unknown(submission, rng):
    """command for other frictions and speeds, both ways"""
    speeds = rng.uniform(0.2, 2.0, 8) * np.tile([1.0, -1.0], 4)
    twins.expect_drives(submission, [(float(rng.uniform(0.1, 2.0)), float(speed)) for speed in speeds])


@pytest.mark.task("command")
@pytest.mark.points(3)
def test_command_closes_loop(submission, rng):
    """command in a loop with other carts, both ways: the speed of the cart"""
    twins.expect_command_closes_loop(submission, rng)
