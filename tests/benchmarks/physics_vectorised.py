"""What a thousand trajectories cost, as a multiple of one: run it with ``python tests/benchmarks/...``.

Every case is timed in the same run, the single and the thousandfold one in turn, and the best of five counts.
The promise is a ratio of at most 20.
"""

import time
from collections.abc import Callable

import numpy as np

from course.physics.body import Body
from course.physics.contact import Surface
from course.physics.dynamics import PassiveArm, TwoLinkArm
from course.physics.integrators import RK4, State, trajectory
from course.physics.rotation import Spin, SplitRotation
from course.physics.simulator import Simulator
from course.physics.state import RigidBodyState

MANY, REPEATS = 1000, 5
RNG = np.random.default_rng(0)


def bouncing(count: int) -> None:
    """Balls thrown onto a floor with friction, for 1 s."""
    places = np.array([0.0, 0.0, 1.0]) + RNG.uniform(-0.4, 0.4, (count, 3))
    ball = Body.sphere(1.0, 0.1, RigidBodyState.of(places, RNG.normal(size=(count, 3))))
    Simulator([ball], h=0.01, surface=Surface(0.6, 0.3)).run(1.0)


def colliding(count: int) -> None:
    """Pairs of balls that meet in free space, for 1 s."""
    left = Body.sphere(
        1.0, 0.1, RigidBodyState.of([-0.5, 0.0, 0.0], RNG.uniform(0.5, 2, (count, 1)) * [1, 0, 0])
    )
    right = Body.sphere(
        1.0, 0.1, RigidBodyState.of([0.5, 0.0, 0.0], RNG.uniform(-2, -0.5, (count, 1)) * [1, 0, 0])
    )
    Simulator([left, right], h=0.01, gravity=0.0, ground=None, surface=Surface(0.8)).run(1.0)


def swinging(count: int) -> None:
    """Double pendulums, Runge-Kutta, 100 steps."""
    start = State.at_rest(RNG.normal(size=(count, 2)))
    trajectory(RK4(), PassiveArm(TwoLinkArm.double_pendulum()), start, 0.01, 100)


def spinning(count: int) -> None:
    """Free bodies, split rotations, 100 steps."""
    spin = Spin(np.tile([1.0, 0.0, 0.0, 0.0], (count, 1)), RNG.normal(size=(count, 3)))
    for _ in range(100):
        spin = SplitRotation().advance(np.array([1.0, 2.0, 3.0]), spin, np.zeros(3), 0.01)


def seconds(case: Callable[[int], None], count: int) -> float:
    start = time.perf_counter()
    case(count)
    return time.perf_counter() - start


def main() -> None:
    for case in (bouncing, colliding, swinging, spinning):
        times = [(seconds(case, 1), seconds(case, MANY)) for _ in range(REPEATS)]
        one, many = (min(column) for column in zip(*times, strict=True))
        verdict = "kept" if many <= 20 * one else "NOT kept"
        print(f"{case.__name__:10} one {1e3 * one:7.1f} ms, {MANY} {1e3 * many:7.1f} ms: "
              f"{many / one:5.2f} times ({verdict})")  # fmt: skip


if __name__ == "__main__":
    main()
