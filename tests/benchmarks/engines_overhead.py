"""What an adapter costs over its engine's own loop, with a hundred boxes: the README's figure.

    python tests/benchmarks/engines_overhead.py [--pairs N] [ENGINE ...]

Stretches of ``World.step(1)``, one call per step as a scenario makes them, are taken in turn with stretches
of the engine's own calls on the same world, so that a busy machine slows both. Reported is the median of the
ratios of processor time.
"""

from __future__ import annotations

import argparse
import statistics
import subprocess
import sys
import time
from typing import TYPE_CHECKING, Any

from course.engines.registry import ENGINES, availability, load

if TYPE_CHECKING:
    from collections.abc import Callable

DT = 1.0 / 240.0
STRETCH_S = 0.1


def own_loop(engine: str, world: Any) -> Callable[[int], None]:
    """The steps as the engine's manual writes them, around the same scene."""
    if engine == "ode":

        def run(n: int) -> None:
            for _ in range(n):
                world.space.autoCollide()
                world.world.quickStep(DT)
                world._joints_of_contacts.empty()

        return run
    call, words, named = _CALLS[engine](world)

    def run_one(n: int) -> None:
        for _ in range(n):
            call(*words, **named)

    return run_one


def _mujoco(world: Any) -> tuple[Any, tuple[Any, ...], dict[str, Any]]:
    import mujoco

    return mujoco.mj_step, (world.model, world.data), {}


def _pybullet(world: Any) -> tuple[Any, tuple[Any, ...], dict[str, Any]]:
    import pybullet

    return pybullet.stepSimulation, (), {"physicsClientId": world._server}


_CALLS: dict[str, Callable[[Any], tuple[Any, tuple[Any, ...], dict[str, Any]]]] = {
    "pymunk": lambda world: (world.space.step, (DT,), {}),
    "mujoco": _mujoco,
    "bullet": lambda world: (world.world.doPhysics, (DT, 1, DT), {}),
    "rapier": lambda world: (world.world.step, (), {}),
    "physx": lambda world: (world.system.step, (), {}),
    "pybullet": _pybullet,
    "dart": lambda world: (world.world.step, (), {}),
}


def measure(engine: str, pairs: int) -> float:
    """Time through the adapter over time without it."""
    from course.engines.scenarios import boxes_scene

    adapter = load(engine)
    world = adapter(boxes_scene(DT), {})
    loop = own_loop(engine, world)
    loop(240)

    def adapted(n: int) -> None:
        for _ in range(n):
            world.step(1)

    def seconds(run: Callable[[int], None], n: int) -> float:
        started = time.process_time()
        run(n)
        return time.process_time() - started

    n = max(5, round(10 * STRETCH_S / max(1e-6, seconds(loop, 10))))
    ratios = []
    for _ in range(pairs):
        # There and back: a pile that still settles makes whatever comes later faster.
        first, own, own_again, last = (seconds(run, n) for run in (adapted, loop, loop, adapted))
        ratios.append((first + last) / (own + own_again))
    return statistics.median(ratios)


def main() -> int:
    """Each engine in a process of its own."""
    parser = argparse.ArgumentParser()
    parser.add_argument("engines", nargs="*")
    parser.add_argument("--pairs", type=int, default=25)
    parser.add_argument("--here", action="store_true", help="measure in this process")
    arguments = parser.parse_args()
    if arguments.here:
        print(f"{arguments.engines[0]:9} {measure(arguments.engines[0], arguments.pairs):.3f}")
        return 0
    for engine in arguments.engines or [i.id for i in ENGINES.values() if availability(i).installed]:
        subprocess.run(
            [sys.executable, __file__, "--here", "--pairs", str(arguments.pairs), engine], check=False
        )
    return 0


if __name__ == "__main__":
    sys.exit(main())
