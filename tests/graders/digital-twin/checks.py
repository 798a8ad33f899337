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
    """An encoder of another resolution counts over many turns both ways"""
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
    """The encoder leaves its angles alone, over a few turns and both ways"""
    theta = sensors.angles_between_counts(rng, 300, 70, 48)
    value = bundles.expect_clean(submission, "encoder", (theta, 48), ("theta", None))
    sensors.expect_counts(submission, value, theta, 48)


# -- gyroscope ------------------------------------------------------------------------------------------


@pytest.mark.task("imu")
@pytest.mark.points(2)
def test_imu_white(submission, rng):
    """At other densities and sampling rates, white noise has the strength that its density gives"""
    calls = [
        (np.zeros(20000), dt, 10 ** rng.uniform(-3.5, -2.0), 0.0, float(rng.normal()), rng)
        for dt in (rng.uniform(0.002, 0.006), rng.uniform(0.05, 0.5))
    ]
    calls.append((*calls[0][:2], 3 * calls[0][2], *calls[0][3:]))  # at the same rate, another density
    sensors.expect_white(submission, calls, 0.04, "the README's")


@pytest.mark.task("imu")
@pytest.mark.points(2)
def test_imu_walk(submission, rng):
    """Over one sample and over ten, the bias wanders with the square root of time"""
    dt, walk = rng.uniform(0.004, 0.05), 0.01 * rng.uniform(0.5, 2.0)
    bias0 = float(rng.normal())
    for rate, strength in ((dt, walk), (2 * dt, walk), (dt, 3 * walk)):
        sensors.expect_walk(submission, 20000, rate, strength, bias0, rng)


@pytest.mark.task("imu")
@pytest.mark.points(2)
def test_imu_randomness(submission, rng):
    """Noise and bias are independent, and both come from the generator that is passed in"""
    sensors.expect_gyroscope_draws(submission, int(rng.integers(2**32)), rng.uniform(0.004, 0.05))


@pytest.mark.task("imu")
@pytest.mark.points(1)
def test_imu_inputs(submission, rng):
    """The true rate is left unchanged, and is in the measured rate exactly as it is"""
    true, dt = 3.0 * np.sin(np.linspace(0, rng.uniform(5, 9), 50)), rng.uniform(0.01, 0.1)
    sensors.expect_rate_kept(submission, true, dt, -0.1, rng)


# -- fit_noise ------------------------------------------------------------------------------------------


@pytest.mark.task("fit_noise")
@pytest.mark.points(5)
def test_fit_noise_unknown(submission, rng):
    """Gyroscopes of other kinds and other sampling rates are identified from their recordings"""
    sensors.expect_fits(submission, sensors.recordings(rng, 12, lambda: sensors.unknown_gyroscope(rng)))


@pytest.mark.task("fit_noise")
@pytest.mark.points(1)
def test_fit_noise_inputs(submission, rng):
    """fit_noise leaves its recording alone"""
    still = scenes.recording(rng, 2000, 0.02, 0.002, 0.003, 0.5)
    for factor, dt in ((1.0, 0.02), (1.0, 0.08), (3.0, 0.02)):  # as long, at another rate, of another kind
        sensors.expect_density_of_short(submission, factor * still, dt, factor * 0.002 * (dt / 0.02) ** 0.5)


# -- lidar ----------------------------------------------------------------------------------------------


@pytest.mark.task("lidar")
@pytest.mark.points(3)
def test_lidar_walls(submission, rng):
    """In a crooked hall with free-standing walls, every beam finds its nearest wall or none"""
    parts.expect_hall(submission, rng)


@pytest.mark.task("lidar")
@pytest.mark.points(3)
def test_lidar_noise(submission, rng):
    """Hits have noise of std sigma from the given generator, and no reading is negative; others are r_max"""
    sensors.expect_scan_noise(submission, rng.uniform(6.0, 9.0), rng.uniform(0.02, 0.08), rng)
    sensors.expect_scan_draws(submission, int(rng.integers(2**32)))


@pytest.mark.task("lidar")
@pytest.mark.points(1)
def test_lidar_inputs(submission, rng):
    """The scanner leaves pose, walls and angles alone"""
    call = (rng.uniform(-1, 1, 3), rays.hall(rng), rng.uniform(-3, 3, 12), 5.0, 0.0, rng)
    value = bundles.expect_clean(submission, "lidar", call, ("pose", "segments", "angles", *[None] * 3))
    parts.expect_ranges(submission, value, *call[:4], "A distance is wrong.")


# -- motor ----------------------------------------------------------------------------------------------

_MOTOR = "The speed of an unknown motor is not what its command, limits and lag make of it."


@pytest.mark.task("motor_step")
@pytest.mark.points(4)
def test_motor_unknown(submission, rng):
    """An unknown motor follows commands large and small, both ways, at steps short and long"""
    tau, u_max, dead = rng.uniform(0.05, 1.0), rng.uniform(5, 20), rng.uniform(0.5, 1.5)
    edges = [factor * dead for factor in (0.5, -0.7, 1.0, -1.0, 1.05, -1.05)]
    commands = rng.permutation([*rng.uniform(-1, 1, 6) * u_max, 2 * u_max, -3 * u_max, *edges])
    calls = [(float(u), tau * float(rng.choice([0.1, 0.7, 2.0, 5.0])), tau, u_max, dead) for u in commands]
    actuators.expect_motor(submission, 0.3 * u_max, calls, _MOTOR)
    first = 0.1 * u_max, 0.8 * u_max, 0.3 * tau, tau, 0.7 * u_max, dead
    actuators.expect_motors(
        submission, first, (0.2 * u_max, 0.6 * u_max, tau, 3 * tau, 0.6 * u_max, 0.9 * u_max)
    )


@pytest.mark.task("motor_step")
@pytest.mark.points(2)
def test_motor_overspeed(submission, rng):
    """A motor that spins faster than the largest command, either way, slows down gradually"""
    tau, u_max = rng.uniform(0.1, 1.0), rng.uniform(5, 20)
    for sign in (1.0, -1.0):
        calls = [(sign * u, 0.3 * tau, tau, u_max, 0.5) for u in (u_max, 0.2, -2 * u_max)]
        actuators.expect_motor(submission, sign * rng.uniform(1.5, 3.0) * u_max, calls, _MOTOR)


# -- backlash -------------------------------------------------------------------------------------------


@pytest.mark.task("backlash")
@pytest.mark.points(5)
def test_backlash_swings(submission, rng):
    """At any speed the output is half the gap behind each way, and stays at rest for small ones"""
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
    (x, dt, late), other = cases[1], rng.normal(1.0, 1.0, 30)
    parts.expect_delays(
        submission, [*cases, *bundles.one_by_one((x, dt, late), (other, 1.3 * dt, 1.17 * late))]
    )


@pytest.mark.task("delay_line")
@pytest.mark.points(2)
def test_delay_edges(submission, rng):
    """No latency, whole samples, more latency than signal; and the output is a new array"""
    x, dt = rng.normal(2.0, 1.0, 12), rng.uniform(0.01, 0.1)
    parts.expect_delays(submission, [(x, dt, 0.0), (x, dt, 3 * dt), (x, dt, 20.3 * dt)])
    actuators.expect_new_signal(submission, x, dt)


# -- differential drive ---------------------------------------------------------------------------------


@pytest.mark.task("diff_drive_step")
@pytest.mark.points(2)
def test_drive_tour(submission, rng):
    """On a tour of many arcs, some backwards and some with many turns, each step is right"""
    parts.expect_tour(submission, rng)


@pytest.mark.task("diff_drive_step")
@pytest.mark.points(3)
def test_drive_slow_turns(submission, rng):
    """As the turn rate goes to zero, the arc becomes a straight line without a jump"""
    actuators.expect_slow_turns(submission, rng)


@pytest.mark.task("diff_drive_step")
@pytest.mark.points(1)
def test_drive_inputs(submission, rng):
    """A step leaves the old pose unchanged"""
    pose, wheels = rng.uniform(1, 2, 3), (0.3, 0.5, 0.4, 1.0)
    value = bundles.expect_clean(submission, "diff_drive_step", (pose, *wheels), ("pose", *[None] * 4))
    actuators.expect_pose(submission, value, pose, wheels)


# -- the twin -------------------------------------------------------------------------------------------


@pytest.mark.task("sync")
@pytest.mark.points(3)
def test_sync_late(submission, rng):
    """Twins keep up, forwards and backwards, even when a third of the measurements come late"""
    message = "With some measurements late, the twin's position is further off than the README allows."
    for sign in (1.0, -1.0):
        twins.expect_keeps_up(submission, rng, sign=sign, late=0.33, message=message)


@pytest.mark.task("sync")
@pytest.mark.points(3)
def test_sync_closes_loop(submission, rng):
    """A cart driven with the friction the twin has learned gets back to its speed after a jump in friction"""
    twins.expect_sync_closes_loop(submission, rng)


@pytest.mark.task("sync")
@pytest.mark.points(2)
@pytest.mark.requires("sync_follows")  # a twin that never changes passes this one as well
def test_sync_repeats(submission, rng):
    """The same twin and measurement give the same result again, and the twin passed in is unchanged"""
    twins.expect_twin_contract(submission, rng)


@pytest.mark.task("command")
@pytest.mark.points(2)
def test_command_unknown(submission, rng):
    """For other frictions and speeds, forwards and backwards, the drive balances the friction"""
    speeds = rng.uniform(0.2, 2.0, 8) * np.tile([1.0, -1.0], 4)
    twins.expect_drives(submission, [(float(rng.uniform(0.1, 2.0)), float(speed)) for speed in speeds])


@pytest.mark.task("command")
@pytest.mark.points(3)
def test_command_closes_loop(submission, rng):
    """Driven by command, carts whose friction jumps reach their speed and return to it, in both directions"""
    twins.expect_command_closes_loop(submission, rng)
