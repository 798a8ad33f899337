"""Where a rigid body is and how it moves: position, velocity, orientation and angular velocity.

Every array may carry leading axes, written ``...``: one state object can then hold a thousand bodies, or one
body in a thousand runs, and everything in this library works on all of them at once.

    ====================  ===========  =======  ====================================
    quantity              shape        unit     frame
    ====================  ===========  =======  ====================================
    position              (..., 3)     m        world, z up
    velocity              (..., 3)     m/s      world
    orientation           (..., 4)     1        unit quaternion [w, x, y, z], body to world
    angular velocity      (..., 3)     rad/s    the body's own axes
    ====================  ===========  =======  ====================================

The angular velocity is kept in the body's axes because the inertia is constant there and nowhere else.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

#: The orientation of a body that was not turned.
IDENTITY = (1.0, 0.0, 0.0, 0.0)
_LENGTHS = {"position": 3, "velocity": 3, "orientation": 4, "angular_velocity": 3}


@dataclass(frozen=True, slots=True, eq=False)
class RigidBodyState:
    """The state of a rigid body; shapes, units and frames are in the table above.

    The leading axes of the four arrays must fit together as NumPy broadcasts them.

    Raises:
        ValueError: an array has the wrong last axis, or the leading axes do not fit together.
    """

    position: Array
    velocity: Array
    orientation: Array
    angular_velocity: Array

    def __post_init__(self) -> None:
        shape = self.position.shape
        alike = shape == self.velocity.shape == self.angular_velocity.shape
        if alike and shape[-1:] == (3,) and self.orientation.shape == (*shape[:-1], 4):
            return  # as in every step of an engine
        for name, length in _LENGTHS.items():
            shape = getattr(self, name).shape
            if not shape or shape[-1] != length:
                raise ValueError(f"{name} must have shape (..., {length}), not {shape}.")
        try:
            _ = self.batch
        except ValueError:
            shapes = ", ".join(f"{name} {getattr(self, name).shape}" for name in _LENGTHS)
            raise ValueError(f"The leading axes do not fit together: {shapes}.") from None

    @classmethod
    def of(
        cls,
        position: ArrayLike,
        velocity: ArrayLike = (0.0, 0.0, 0.0),
        orientation: ArrayLike = IDENTITY,
        angular_velocity: ArrayLike = (0.0, 0.0, 0.0),
    ) -> Self:
        """A state from anything array-like, copied to float; the quaternion is normalised.

        Raises:
            ValueError: a shape is wrong, a number is not finite, or a quaternion has no length.
        """
        given = (position, velocity, orientation, angular_velocity)
        arrays = dict(zip(_LENGTHS, (np.array(value, dtype=float) for value in given), strict=True))
        for name, value in arrays.items():
            if not np.all(np.isfinite(value)):
                raise ValueError(f"{name} must be finite numbers, not {value.tolist()}.")
        turn = arrays["orientation"]
        size = np.linalg.norm(turn, axis=-1, keepdims=True)
        if np.any(size == 0.0):
            raise ValueError("A quaternion of length 0 is not an orientation; use [1, 0, 0, 0].")
        return cls(arrays["position"], arrays["velocity"], turn / size, arrays["angular_velocity"])

    @property
    def batch(self) -> tuple[int, ...]:
        """The leading axes: () for one body in one run."""
        shapes = {getattr(self, name).shape[:-1] for name in _LENGTHS}
        return shapes.pop() if len(shapes) == 1 else np.broadcast_shapes(*shapes)

    def broadcast(self, batch: tuple[int, ...]) -> RigidBodyState:
        """The same state with these leading axes, every array with memory of its own."""
        return RigidBodyState(
            *(
                np.broadcast_to(getattr(self, name), (*batch, length)).copy()
                for name, length in _LENGTHS.items()
            )
        )
