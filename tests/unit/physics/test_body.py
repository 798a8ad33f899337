"""States and bodies: shapes are checked where they enter, forces add up, nonsense is refused."""

import math

import numpy as np
import pytest

from course.physics.body import Body
from course.physics.state import RigidBodyState


def test_a_state_from_lists_has_float_arrays_and_a_unit_quaternion():
    state = RigidBodyState.of([1, 2, 3], orientation=[2, 0, 0, 0])
    assert state.position.dtype == np.float64
    assert state.orientation.tolist() == [1.0, 0.0, 0.0, 0.0]
    assert state.batch == ()


def test_a_state_does_not_share_memory_with_what_it_was_made_of():
    position = np.zeros(3)
    assert not np.shares_memory(RigidBodyState.of(position).position, position)


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("position", [0.0, 0.0], "position must have shape"),
        ("velocity", 1.0, "velocity must have shape"),
        ("orientation", [1.0, 0.0, 0.0], "orientation must have shape"),
        ("angular_velocity", [0.0] * 4, "angular_velocity must have shape"),
        ("velocity", [np.nan, 0.0, 0.0], "velocity must be finite"),
        ("orientation", [0.0] * 4, "length 0"),
    ],
)
def test_what_is_no_state_is_named(name, value, words):
    arguments = {"position": np.zeros(3), name: value}
    with pytest.raises(ValueError, match=words):
        RigidBodyState.of(**arguments)


def test_leading_axes_broadcast_and_those_that_do_not_fit_are_named():
    assert RigidBodyState.of(np.zeros((5, 1, 3)), np.zeros((4, 3))).batch == (5, 4)
    with pytest.raises(ValueError, match=r"position \(5, 3\)"):
        RigidBodyState.of(np.zeros((5, 3)), np.zeros((4, 3)))


def test_a_broadcast_state_owns_its_memory():
    wide = RigidBodyState.of(np.zeros(3)).broadcast((6,))
    wide.position[0] = 1.0
    assert wide.position.shape == (6, 3)
    assert np.all(wide.position[1] == 0.0)


def test_forces_and_torques_add_up_until_they_are_cleared():
    body = Body(2.0, RigidBodyState.of(np.zeros(3)))
    body.add_force([1.0, 0.0, 0.0])
    body.add_force([1.0, 0.0, 4.0])
    body.add_torque([3.0, 0.0, 0.0])
    body.add_torque([1.0, 0.0, -1.0])
    assert body.acceleration().tolist() == [1.0, 0.0, 2.0]
    assert body.torque.tolist() == [4.0, 0.0, -1.0]
    body.clear()
    assert not body.force.any()
    assert not body.torque.any()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"mass": 0.0}, "mass must be positive"),
        ({"mass": -1.0}, "mass must be positive"),
        ({"mass": math.nan}, "mass must be positive"),
        ({"inertia": [1.0, 1.0, 2.1]}, "No body has the moments"),
        ({"inertia": [1.0, 1.0, -2.0]}, "must be positive"),
        ({"radius": -1.0}, "radius"),
    ],
)
def test_a_body_that_cannot_be_is_refused(options, words):
    with pytest.raises(ValueError, match=words):
        Body(**{"mass": 1.0, "state": RigidBodyState.of(np.zeros(3)), **options})


def test_a_point_mass_never_turns_and_has_no_energy_of_rotation():
    body = Body(2.0, RigidBodyState.of(np.zeros(3), [3.0, 0.0, 0.0], angular_velocity=[1.0, 0.0, 0.0]))
    assert body.kinetic_energy() == pytest.approx(0.5 * 2.0 * 9.0)
    assert not body.angular_momentum().any()


def test_a_rolling_ball_carries_two_sevenths_of_its_energy_in_its_spin():
    rolling = RigidBodyState.of(np.zeros(3), [1.0, 0.0, 0.0], angular_velocity=[0.0, 2.0, 0.0])
    ball = Body.sphere(1.0, 0.5, rolling)
    still = Body.sphere(1.0, 0.5, RigidBodyState.of(np.zeros(3), angular_velocity=[0.0, 2.0, 0.0]))
    assert still.kinetic_energy() / ball.kinetic_energy() == pytest.approx(2 / 7)
