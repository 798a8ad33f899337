"""The view in a terminal: CPU time and bytes of a frame, by scene and size of the window.

The program is run as its users run it: textual's own driver writes into a pseudo-terminal that is read and
thrown away, thirty frames for each simulated second; steps of physics are counted apart. What is asked for:
thirty frames a second at 80x24 that send only rows that changed, so 33 ms a frame at most. On a machine that
does other things as well the tenth percentile says more about the program than the median does.

    python tests/benchmarks/sandbox_terminal.py [--frames N] [--json] [SCENE ...]
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import pty
import statistics
import sys
import threading
import time
from typing import Any

from textual.geometry import Size

from course.sandbox.scene.loading import choose
from course.sandbox.views.stage import Stage
from course.sandbox.views.terminal.app import SandboxApp

FPS = 30.0
SIZES = ((80, 24), (160, 50))
SCENES = ("newtons-cradle", "billiards-break", "galton-board", "dominoes")


class _Counter:
    """The reading end of a terminal: bytes that arrived."""

    def __init__(self, end: int) -> None:
        self.bytes = 0
        self._end = end
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        while True:
            try:
                data = os.read(self._end, 65536)
            except OSError:
                return
            if not data:
                return
            self.bytes += len(data)


def measure(scene: str, size: tuple[int, int], frames: int) -> dict[str, Any]:
    """One scene at one size."""
    chosen = choose(scene)
    clock = _Clock()
    app = _Measured(Stage(chosen, clock=clock), fps=FPS, clock=clock)
    app.plan(clock, frames, size)
    outer, inner = pty.openpty()
    counter = _Counter(outer)
    real_out, real_err = sys.__stdout__, sys.__stderr__
    os.environ["COLUMNS"], os.environ["LINES"] = map(str, size)
    with os.fdopen(inner, "w", closefd=False) as terminal:
        sys.__stdout__ = sys.__stderr__ = terminal  # type: ignore[misc]
        try:
            app.run(size=size, mouse=False)
        finally:
            sys.__stdout__, sys.__stderr__ = real_out, real_err  # type: ignore[misc]
    time.sleep(0.05)
    if app.failure is not None:
        raise app.failure
    drawn = sorted(app.drawing)
    return {
        "scene": scene,
        "size": f"{size[0]}x{size[1]}",
        "bodies": len(app.world.parts),
        "frames": len(drawn),
        "steps_ms": round(1e3 * statistics.median(app.stepping), 2),
        "p10_ms": round(1e3 * drawn[len(drawn) // 10], 2),
        "view_ms": round(1e3 * statistics.median(drawn), 2),
        "p90_ms": round(1e3 * drawn[len(drawn) * 9 // 10], 2),
        "rows": round(app.canvas.sent / len(drawn), 1),
        "of_rows": app.rows,
        "bytes": round(counter.bytes / len(drawn)),
    }


class _Clock:
    """Real time that passes only when told to."""

    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


class _Measured(SandboxApp):
    """The view, driven frame by frame."""

    def plan(self, clock: _Clock, frames: int, size: tuple[int, int]) -> None:
        """How many frames of which size."""
        self.clock, self.frames, self.wanted = clock, frames, Size(*size)
        self.rows = 0
        self.stepping: list[float] = []
        self.drawing: list[float] = []

    def begin(self) -> None:
        """Frames from here, not from a timer."""
        self.world.paused = False
        self._last = self.clock()
        advance = self.stage.tick

        def timed(dt: float, budget: float) -> list[Any]:
            began = time.process_time()
            told = advance(dt, budget)
            self.stepping.append(time.process_time() - began)
            return told

        self.stage.tick = timed  # type: ignore[method-assign]
        self.run_worker(self._frames())

    async def _frames(self) -> None:
        await asyncio.sleep(0.3)
        for _ in range(10):
            await self._frame()
        self.stepping.clear()
        self.canvas.sent = 0
        for _ in range(self.frames):
            spent = await self._frame()
            self.drawing.append(spent - self.stepping[-1])
        self.rows = self.canvas.size.height
        self.exit()

    async def _frame(self) -> float:
        self.clock.now += 1 / FPS
        began = time.process_time()
        self.tick()
        # Textual puts what changed together and sends it in its own time.
        await asyncio.sleep(0.02)
        return time.process_time() - began


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scenes", nargs="*", default=SCENES)
    parser.add_argument("--frames", type=int, default=120)
    parser.add_argument("--json", action="store_true")
    given = parser.parse_args()
    rows = [measure(scene, size, given.frames) for scene in given.scenes or SCENES for size in SIZES]
    if given.json:
        print(json.dumps(rows))
        return
    print("  ".join(f"{name:>15}" if name == "scene" else f"{name:>11}" for name in rows[0]))
    for row in rows:
        print("  ".join(f"{row[n]:>15}" if n == "scene" else f"{row[n]:>11}" for n in row))


if __name__ == "__main__":
    main()
