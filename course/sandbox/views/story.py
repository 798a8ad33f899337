"""The text of a view: events as they happen, and the result of the prediction."""

import math
from collections import deque
from collections.abc import Callable, Sequence
from typing import Any

import msgspec

from course.errors import UsageError
from course.sandbox.runs.running import Probes, sentence, worth_telling
from course.sandbox.scene.loading import Chosen, Comparison, question, with_settings
from course.sandbox.world.accounts import Event
from course.sandbox.world.world import World

#: Sentences that a view gets when it opens in the middle of a run.
_KEPT = 60
#: Contacts and stops that are reported at once, and per second of real time; a reader cannot follow more.
_BURST, _RATE = 10.0, 4.0
#: Events kept for the probes of one run.
_MOST = 50_000


class Narrator:
    """Turns events into the lines of a list: what happened, and where."""

    def __init__(self) -> None:
        self._last: dict[tuple[str, str], float] = {}
        self._told: deque[dict[str, Any]] = deque(maxlen=_KEPT)
        self._free, self._then, self._left = _BURST, 0.0, 0
        self._done = ("", -1.0)

    def told(self) -> list[dict[str, Any]]:
        """The latest lines, oldest first."""
        return list(self._told)

    def forget(self) -> None:
        """The world was reset: the lines belong to a run that is over."""
        self._last.clear()
        self._told.clear()
        self._left = 0

    def tell(self, events: Sequence[Event], now: float) -> list[dict[str, Any]]:
        """Lines for the events that are worth one.

        Args:
            events: in order.
            now: real time in s. Only a limited number of contacts and stops is reported each second; the
                others are counted.
        """
        self._free = min(_BURST, self._free + _RATE * (now - self._then))
        self._then = now
        lines: list[dict[str, Any]] = []
        for event in events:
            if event.kind == "contact" and not worth_telling(event, self._last):
                continue
            if event.kind == "input":  # a body that is carried is put elsewhere in every frame
                same, self._done = self._done == (event.text, event.t), (event.text, event.t)
                if same:
                    continue
            if event.kind in {"contact", "rest"} and not self._may():
                continue
            if self._left:
                what = "contact or stop" if self._left == 1 else "contacts and stops"
                lines.append({"text": f"{self._left} more {what}.", "kind": "more"})
                self._left = 0
            lines.append(_line(event))
        self._told.extend(lines)
        return lines

    def _may(self) -> bool:
        if self._free < 1.0:
            self._left += 1
            return False
        self._free -= 1.0
        return True


def _line(event: Event) -> dict[str, Any]:
    line: dict[str, Any] = {"text": sentence(event), "kind": event.kind, "t": event.t}
    if event.kind == "contact":
        line |= {"x": event.x, "y": event.y, "speed": event.approach}
    return line


class Experiment:
    """Theory, simulation and, if somebody made one, a guess side by side, at the end of the scene's time.

    The run on the screen is compared, as long as the user moved no body: the theory is not about a ball that
    the user threw. Settings may be changed before the first step; theory takes them into account. The run
    goes on after it.

    Args:
        world: before its first step.
        keep: called with each comparison that has a guess.
    """

    def __init__(
        self, world: World, chosen: Chosen, guess: float | None, keep: Callable[[Comparison], None] | None
    ) -> None:
        self._world, self._chosen, self.keep = world, chosen, keep
        self._listeners = tuple(world.on_block)
        self._probes: Probes | None = None
        self._events: list[Event] = []
        self._comparison: dict[str, Any] | None = None
        self._asked: tuple[dict[str, float] | None, str] = (None, "")
        self.guess = guess
        #: "none" (nothing is asked), "ask" (nobody guessed), "run" (somebody did), "touched" (not
        #: comparable any more) or "done".
        self.stage = "none"
        if chosen.scene.prediction is not None:
            self._begin()

    def _begin(self) -> None:
        self.stage = "ask" if self.guess is None else "run"
        self._events = []
        self._comparison = None
        self._world.on_block[:] = self._listeners
        self._probes = Probes(self._world, self._chosen)

    def answer(self, guess: float | None) -> None:
        """Take the guess, or None for none; it counts for all runs from here on."""
        if self.stage in {"ask", "run"}:
            self.guess = guess
            self.stage = "ask" if guess is None else "run"

    def again(self) -> None:
        """The world was reset."""
        if self.stage != "none":
            self._begin()

    def felt(self, what: str) -> None:
        """Something was done to the world. Settings may change before the first step: theory knows them."""
        changed = what not in {"reset", "drag", "release"} and not (what == "set" and self._world.steps == 0)
        if changed and self.stage in {"ask", "run"}:
            self.stage = "touched"

    def take(self, events: Sequence[Event]) -> None:
        """Hand events to the probes."""
        if self.stage in {"ask", "run"} and len(self._events) < _MOST:
            self._events += [event for event in events if event.kind == "contact"]

    def left(self) -> float:
        """Simulated time until the comparison, in s; infinite if there will be none."""
        if self.stage not in {"ask", "run"}:
            return math.inf
        return max(0.0, self._chosen.scene.duration - self._world.t)

    def passed(self) -> None:
        """After time has passed and ``take`` has the events: compare, if the run has reached its end."""
        probes = self._probes
        if probes is None or self.left() > 1e-9:
            return
        comparison = probes.compared(probes.read(self._events), self.guess)
        self._comparison = msgspec.to_builtins(comparison)
        self.stage = "done"
        self._events = []
        self._world.on_block[:] = self._listeners
        if self.keep is not None and self.guess is not None and comparison is not None:
            self.keep(comparison)

    @property
    def question(self) -> str:
        """The scene's question, with the present settings; "" if it has none."""
        if self._asked[0] != self._world.settings:  # a layout of every body, and pages ask in each frame
            try:
                text = question(with_settings(self._chosen, self._world.settings))
            except UsageError:  # at these settings together; the formula itself is the honest text
                text = self._chosen.scene.prediction.question if self._chosen.scene.prediction else ""
            self._asked = dict(self._world.settings), text
        return self._asked[1]

    def report(self) -> dict[str, Any]:
        """For pages."""
        return {
            "stage": self.stage,
            "question": self.question,
            "guess": self.guess,
            "comparison": self._comparison,
        }
