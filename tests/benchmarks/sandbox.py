"""What the sandbox costs on top of pymunk, as ratios within one run.

    python tests/benchmarks/sandbox.py [--rounds 15] [--json]

A hundred bodies (50 balls, 50 boxes) fall into a box, and Newton's cradle swings. A world with its account, a
world without one, and a bare pymunk space built from the same parts take turns, a slice of steps each, in an
order that rotates; the figure is the ratio of their CPU times. Bare means `Space.step` in a loop,
with nobody listening. All three are the same simulation: their states are compared bit by bit at the end.
"""

from __future__ import annotations

import argparse
import json
import statistics
import time
from typing import Any

from course.sandbox.scene.loading import choose
from course.sandbox.scene.model import Body, Material, Repeat, Scene, layout
from course.sandbox.world.engine import Space
from course.sandbox.world.world import World

#: Steps in a slice; long enough that timers do not matter, short enough that a busy machine hits all alike.
SLICE = 96


def pile() -> Scene:
    """A hundred bodies that fall into a box and come to rest."""
    wall = {"shape": "box", "material": "stone", "fixed": True}
    common = {"material": "stone", "mass": 1.0, "jitter": 0.01}
    return Scene(
        format_version=1,
        id="pile",
        title="A pile",
        order=99,
        teaches="-",
        note="-",
        after="-",
        view=(-4, -0.5, 4, 8),
        gravity=(0.0, -9.81),
        material=(Material(name="stone", restitution=0.5, friction=0.7),),
        body=(
            Body(name="floor", size=(6.4, 0.2), position=(0, -0.1), **wall),
            Body(name="left", size=(0.2, 12), position=(-3.1, 6), **wall),
            Body(name="right", size=(0.2, 12), position=(3.1, 6), **wall),
            Body(
                name="ball",
                shape="circle",
                radius=0.14,
                position=(-2.7, 0.3),
                repeat=(Repeat(count=10, offset=(0.58, 0)), Repeat(count=5, offset=(0, 0.7))),
                **common,
            ),
            Body(
                name="box",
                shape="box",
                size=(0.26, 0.26),
                position=(-2.6, 0.65),
                repeat=(Repeat(count=10, offset=(0.58, 0)), Repeat(count=5, offset=(0, 0.7))),
                **common,
            ),
        ),
    )


class _Bare:
    def __init__(self, scene: Scene) -> None:
        self.made = Space(layout(scene), scene.joint, iterations=scene.iterations, slop=scene.slop)
        self.made.space.gravity = scene.gravity
        self.size = scene.step

    def step(self, count: int) -> None:
        space, size = self.made.space, self.size
        for _ in range(count):
            space.step(size)


def ratios(scene: Scene, rounds: int) -> dict[str, object]:
    """Slices in turn; the ratio of sums, and of each round."""
    runners: dict[str, Any] = {
        "bare": _Bare(scene),
        "world": World(scene, receipt=False),
        "receipt": World(scene),
    }
    spent: dict[str, list[float]] = {name: [] for name in runners}
    names = list(runners)
    for number in range(rounds):
        for name in names[number % 3 :] + names[: number % 3]:
            runner = runners[name]
            began = time.process_time()
            runner.step(SLICE)
            if isinstance(runner, World):
                runner.drain_events()
            spent[name].append(time.process_time() - began)
    end = runners["bare"].made.state().tobytes()
    same = all(runners[name].state().tobytes() == end for name in ("world", "receipt"))
    report: dict[str, object] = {"steps": rounds * SLICE, "same_state": same}
    for name in names:
        report[f"{name}_us_per_step"] = round(1e6 * sum(spent[name]) / (rounds * SLICE), 1)
    for name in ("world", "receipt"):
        each = [a / b for a, b in zip(spent[name], spent["bare"], strict=True)]
        report[f"{name}_ratio"] = round(sum(spent[name]) / sum(spent["bare"]), 3)
        report[f"{name}_ratio_median"] = round(statistics.median(each), 3)
    return report


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=15)
    parser.add_argument("--json", action="store_true")
    given = parser.parse_args()
    result: dict[str, dict[str, Any]] = {
        "a hundred bodies": ratios(pile(), given.rounds),
        "cradle": ratios(choose("newtons-cradle").scene, given.rounds),
    }
    if given.json:
        print(json.dumps(result))
        return
    for title, values in result.items():
        print(title)
        for name, value in values.items():
            print(f"  {name}: {value}")


if __name__ == "__main__":
    main()
