"""The process that one engine runs in: ``python -P -m course.engines.worker ENGINE``.

It answers each line of JSON on its standard input with one on its standard output. An engine's own output
goes to standard error, where the parent finds the last lines of one that died.
"""

import functools
import json
import os
import signal
import sys
import time
from collections.abc import Callable, Mapping
from typing import Any

from course.engines.base import (
    AS_IT_COMES,
    Adapter,
    EngineDivergedError,
    NotApplicableError,
    Scene,
    Tuning,
    World,
)
from course.engines.base import tuning as tuning_of
from course.engines.registry import load
from course.engines.scenarios import boxes_scene, get
from course.errors import InternalError


class EngineServer:
    """Runs jobs with one engine.

    Args:
        tuning: the options of the engine well set, by scenario.
    """

    def __init__(self, adapter: Adapter, tuning: Callable[[str], Tuning]) -> None:
        self._adapter = adapter
        self._tuning = tuning
        self._boxes: World | None = None

    def answer(self, job: Mapping[str, Any]) -> dict[str, Any]:
        """The reply to one job; a failure is a reply too."""
        try:
            return self._do(job)
        except EngineDivergedError as error:
            return {"status": "diverged", "message": error.message}
        except NotApplicableError as error:
            return {"status": "not_applicable", "message": error.message}
        except Exception as error:  # noqa: BLE001 - whatever an engine raises becomes a row that says so
            return {"status": "failed", "message": f"{type(error).__name__}: {error}"}

    def _do(self, job: Mapping[str, Any]) -> dict[str, Any]:
        if job["do"] == "chunk":
            return self._chunk(job["steps"])
        scenario = get(job["scenario"])
        tuning = self._tuning(scenario.id) if job["setting"] == "tuned" else AS_IT_COMES
        if "options" in job:
            # While it is being found out which ones are best.
            tuning = Tuning(job["options"])
        known = {"options": dict(tuning.options), "why": list(tuning.why)}
        if job["do"] == "options":
            return {"status": "ok", **known}

        def build(scene: Scene) -> World:
            return self._adapter(scene, tuning.options)

        if scenario.run is None:
            self._boxes = build(boxes_scene(job["dt"]))
            self._boxes.step(round(0.25 / job["dt"]))
            return {"status": "ok", "contacts": len(self._boxes.overlaps()), **known}
        outcome = scenario.run(build, job["dt"], job["quick"])
        seen = {"samples": outcome.samples, "details": outcome.details}
        return {"status": "ok", "value": float(outcome.value), **seen, **known}

    def _chunk(self, steps: int) -> dict[str, Any]:
        if self._boxes is None:
            raise InternalError("A stretch of the boxes was asked for before the boxes.")
        # CPU time, not wall time: the time on an otherwise idle core.
        started = time.process_time()
        self._boxes.step(steps)
        seconds = max(time.process_time() - started, 1e-6)
        self._boxes.motion().checked()
        return {"status": "ok", "seconds": seconds}


def main(arguments: list[str]) -> int:
    """Serve until standard input ends."""
    replies = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)

    def say(reply: Mapping[str, Any]) -> None:
        replies.write(json.dumps(reply) + "\n")
        replies.flush()

    try:
        desk = EngineServer(load(arguments[0]), functools.partial(tuning_of, arguments[0]))
    except Exception as error:  # noqa: BLE001 - an extension module may raise anything when it cannot load
        say({"status": "unavailable", "message": f"{type(error).__name__}: {error}"})
        return 0
    say({"status": "ok"})
    for line in sys.stdin:
        job = json.loads(line)
        if hasattr(signal, "alarm"):
            # Nothing may be left to end this process: the parent can be gone by the time an engine hangs.
            signal.alarm(int(job["seconds"]) + 5)
        say(desk.answer(job))
    return 0


if __name__ == "__main__":
    code = main(sys.argv[1:])
    # Engines that crash while shutting down have already sent all results.
    sys.stderr.flush()
    os._exit(code)
