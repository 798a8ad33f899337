"""A scene that is played: its world, experiment, story and history, and all that can be done to them.

Views draw a stage and pass on what hands do. They hold no physics and no history of their own.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from time import perf_counter
from typing import Any

from course.errors import CourseError, UsageError
from course.sandbox.runs.recording import Recording, remade
from course.sandbox.runs.tape import Filming, Frame, Tape, frame
from course.sandbox.scene.loading import Chosen, Comparison, choose, own_copy
from course.sandbox.scene.model import Part
from course.sandbox.views.story import Experiment, Narrator
from course.sandbox.world.accounts import Event
from course.sandbox.world.world import World

#: A run that is over sooner than this, in s, starts in slow motion so that it can be seen, for so many s.
_BLINK, _SEEN = 0.5, 2.0
#: Steps between looks at the clock.
_CHUNK = 16
#: The longest stretch of real time that is made up for, in s.
_GAP = 0.1
#: How much of a frame's time may go into steps, in s; the rest is for drawing and for being quick.
BUDGET = 0.012
#: A step of a view: the time of one picture, in s. And how far to look for the next contact, in s.
_PICTURE, _AHEAD = 1 / 60, 10.0
#: Changes of one setting within this simulated time, in s, are undone together.
_TOGETHER = 0.5
#: The last stretch of a run that is made again with its account and its story; what is on a tape before, is
#: taken from there, in s.
_TOLD = 15.0
#: Moments that can be gone back to.
_UNDOS = 1000
#: What does not change the world's future by itself, or belongs to what came before.
_PART_OF_ONE = {"drag", "release"}


@dataclass(frozen=True)
class Desk:
    """What a view may ask of the program around it.

    Attributes:
        keep: a comparison that has a guess.
        save: writes a file of this name into the user's folder, and says where it is.
        played: ids of the scenes that were played before, or are from now on.
        opened: called with the id of a scene that is opened.
    """

    keep: Callable[[Chosen, Comparison], None] | None = None
    save: Callable[[str, bytes], str] | None = None
    played: set[str] = field(default_factory=set)
    opened: Callable[[str], None] | None = None

    def opens(self, stage: Stage) -> None:
        """This is played from now on."""
        self.played.add(stage.chosen.scene.id)
        if self.opened is not None:
            self.opened(stage.chosen.scene.id)

    def stage(
        self, of: Chosen | str, clock: Callable[[], float] = perf_counter, guess: float | None = None
    ) -> Stage:
        """A scene to play, also by its id or path."""
        chosen, keep = choose(of) if isinstance(of, str) else of, self.keep
        kept = None if keep is None else lambda comparison: keep(chosen, comparison)
        return Stage(chosen, guess=guess, keep=kept, clock=clock)

    def mine(self, stage: Stage) -> tuple[Stage, str]:
        """The scene as a file of one's own, to play, and where it is."""
        if self.save is None:
            raise UsageError("Nothing can be saved from here.", code="no_save")
        id_ = f"my-{stage.chosen.scene.id.removeprefix('my-')}"
        path = self.save(f"{id_}.toml", own_copy(stage.chosen, id_))
        made = self.stage(path, stage.clock)
        made.world.paused = stage.world.paused
        says = f"This is your own copy now: {path}. Change it in an editor; it plays like any scene."
        now, theirs = stage.world.settings, made.world.settings
        if changed := [key for key, value in now.items() if theirs.get(key) != value]:
            says += f" It has your parameters, but not what was set besides: {', '.join(changed)}."
        return made, says


@dataclass(frozen=True)
class Moment:
    """A moment that can be made again, to the last bit.

    Attributes:
        count, tick: the inputs and the steps that led to it.
        why: what was done next, in a few words.
    """

    chosen: Chosen
    recording: Recording
    count: int
    tick: int
    t: float
    why: str = ""


@dataclass
class _Work:
    """A moment that is being made again."""

    steps: Iterator[float]
    done: Callable[[], None]
    says: str
    share: float = 0.0


class Stage:
    """A scene that is played.

    Args:
        guess: an answer to its question that was given elsewhere.
        keep: called with each comparison that has a guess.
        clock: real time, in s.

    Attributes:
        at: the time of this run that is looked at, in s; None for the present.
        way: 1 and -1 play what is kept, forwards or backwards; 0 stands.
        ghost: the tape of the run before, if there was one.
        pace: the share of the requested steps that was made lately, 0 to 1.
        news: sentences for whoever plays; a view takes them out.
        heard: the events of the last tick.
        anew: changes when the story does not go on from what was told: tell it from its start.
    """

    def __init__(
        self,
        chosen: Chosen,
        *,
        guess: float | None = None,
        keep: Callable[[Comparison], None] | None = None,
        clock: Callable[[], float] = perf_counter,
    ) -> None:
        self.keep = keep
        self.clock = clock
        self.ghost: Tape | None = None
        self.pace = 1.0
        self.anew = 0
        self.news: list[str] = []
        self.heard: list[Event] = []
        self._lines: list[dict[str, Any]] = []
        self.at: float | None = None
        self.way = 0
        self._work: _Work | None = None
        self._undos: list[Moment] = []
        self._redos: list[Moment] = []
        self._last: tuple[str, Any, float] = ("", None, -math.inf)
        self._begin(chosen, guess)
        if chosen.scene.duration < _BLINK:
            self.world.speed = float(f"{chosen.scene.duration / _SEEN:.1g}")

    def _begin(self, chosen: Chosen, guess: float | None, version: int = 1) -> None:
        self.chosen = chosen
        self.world = World(chosen.scene, chosen.settings)
        self.world.version = version
        self.recording = Recording(self.world)
        self.tape = Tape(self.world, self.recording)
        self.experiment = Experiment(self.world, chosen, guess, self.keep)
        self.narrator = Narrator()

    # -- what is shown ---------------------------------------------------------------------------

    @property
    def working(self) -> tuple[str, float] | None:
        """What is being made again, and how far it is, 0 to 1; None if nothing is."""
        return (self._work.says, self._work.share) if self._work else None

    @property
    def t(self) -> float:
        """The time that is shown, in s."""
        return self.world.t if self.at is None else self.at

    @property
    def still(self) -> bool:
        """Nothing will move by itself."""
        if self._work is not None:
            return False
        return self.world.paused if self.at is None else self.way == 0

    def frame(self, number: int = 0) -> Frame:
        """What is shown, as numbers."""
        if self.at is None:
            return frame(self.world, self.pace, number)
        return self.tape.frames[self.tape.at(self.at)]

    def parts(self, shown: Frame) -> tuple[Part, ...]:
        """The bodies of a frame of this run."""
        version = int(shown[1])
        return self.world.parts if version == self.world.version else self.tape.casts[version]

    def undoable(self) -> tuple[str, str]:
        """What undo and redo would change, in words; "" if they would do nothing."""
        return (self._undos[-1].why if self._undos else ""), (self._redos[-1].why if self._redos else "")

    # -- what is done ----------------------------------------------------------------------------

    def act(self, what: str, *arguments: Any) -> Any:
        """Do something to the world: a method of it, by name. Everything that hands do comes through here.

        Raises:
            UsageError: it cannot be done, or the past is looked at.
        """
        self._must_be_now()
        before = self._now(_in_words(what, arguments))
        if what == "reset":
            self.ghost = self.tape if len(self.tape) > 1 else self.ghost
        count = len(self.recording.inputs)
        result = getattr(self.world, what)(*arguments)
        if what == "reset":
            self.tape.end()
            self.tape = Tape(self.world, self.recording)
            self.experiment.again()
            self.narrator.forget()
            self.anew += 1
        elif what == "set" and arguments[0] == "step":
            self.tape.pace_itself()
        if len(self.recording.inputs) > count and what not in _PART_OF_ONE:
            self.experiment.felt(what)
            self._remember(what, arguments, before)
        if self.world.paused and what not in _PART_OF_ONE:
            self.tape.take()
        return result

    def guess(self, value: float | None) -> None:
        """Answer the scene's question; the run that is compared begins now."""
        if self.world.steps > 0 or self.experiment.stage in {"touched", "done"}:
            self.present()
            self.act("reset")
        self.experiment.answer(value)
        self.world.paused = False

    def run(self, *, on: bool) -> None:
        """Run or pause; of the past, play what is kept."""
        if self.at is None:
            self.world.paused = not on
        else:
            self.way = int(on)

    def step(self, kind: str = "picture") -> None:
        """Pause, and go on by a "picture", to the next "contact", by a step of the "solver", or "back".

        What is kept of the past are pictures: there a step of the solver is one of them.
        """
        if self.at is not None or kind == "back":
            on = self.t + _PICTURE * (-1 if kind == "back" else 1)
            if kind == "contact":  # the next that was marked, or else now
                on = next((t for t in self.tape.marks if t > self.t), self.world.t)
            self.look(on)
            return
        world, began = self.world, self.clock()
        world.paused = True
        if kind == "solver":
            world.step()
        elif kind == "contact":
            self.hear()
            until, met = world.t + _AHEAD, False
            while world.t < until and not met and self.clock() - began < 3.0:
                world.step(max(1, round(_PICTURE / 8 / world.settings["step"])))
                self.hear()
                met = any(event.kind == "contact" and not event.minor for event in self.heard)
            if not met:
                self.news.append("No contact came.")
        else:
            world.step(max(1, round(min(_PICTURE, self.chosen.scene.duration / 60) / world.settings["step"])))
        self.tape.take()

    def look(self, t: float | None) -> None:
        """Look at a time of this run; None or its end is the present. Time stands meanwhile."""
        self._must_be_idle()
        if t is None:
            self.present()
            return
        if self.at is None:
            if self.world.held:
                self.act("release")
            self.tape.take()
        self.way = 0
        self.world.paused = True
        self.at = min(max(t, self.tape.times[0]), self.world.t)
        if self.at >= self.world.t:
            self.at = None

    def play_back(self, way: int) -> None:
        """Play what is kept, forwards (1), backwards (-1), or stop (0)."""
        if self.at is None and way < 0:
            self.look(self.world.t - 1e-6)
        self.way = way if self.at is not None else 0

    def present(self) -> None:
        """Back to now."""
        self.at, self.way = None, 0

    def go_on(self) -> None:
        """Go on from the moment that is looked at: what came after it becomes the ghost."""
        self._must_be_idle()
        if self.at is None:
            return
        tick = self.tape.ticks[self.tape.at(self.at)]
        count = sum(one.tick <= tick for one in self.recording.inputs)
        t, now = self.tape.times[self.tape.at(self.at)], self._now("going on from earlier")

        def leave() -> None:
            self._push(self._undos, now)
            self._redos.clear()
            self.ghost = self.tape

        there = Moment(self.chosen, self.recording, count, tick, t)
        self._make(there, f"Going on from {t:.2f} s", leave, paused=False)

    def undo(self) -> None:
        """Back to the moment before the last thing that was done."""
        self._jump(self._undos, self._redos, "undo")

    def redo(self) -> None:
        """Take back the last undo."""
        self._jump(self._redos, self._undos, "redo")

    def stop_work(self) -> None:
        """Give up what is being made again; everything is as it was."""
        if self._work is not None:
            self._work = None
            self.news.append("Stopped: everything is as it was.")

    def set_parameter(self, name: str, value: float) -> None:
        """The scene from its start with another value of one of its own parameters."""
        self._must_be_now()
        # The settings that somebody chose, not those that the scene has of its own.
        inputs = [one.arguments for one in self.recording.inputs if one.what == "set"]
        given = self.chosen.settings | {str(key): float(value) for key, value in inputs}
        chosen = choose(
            str(self.chosen.path) if self.chosen.own else self.chosen.scene.id,
            {**self.chosen.parameters, "seed": self.chosen.scene.seed, **given, name: value},
        )
        before = self._now(f"{name} {self.chosen.parameters[name]:g}")
        self._remember("parameter", (name,), before)
        self.ghost = self.tape if len(self.tape) > 1 else self.ghost
        old = self.world
        self._begin(chosen, self.experiment.guess, old.version + 1)
        self.world.paused, self.world.speed = old.paused, old.speed
        self.anew += 1

    def film(self, kind: str, width: int) -> Filming:
        """Begin a film of this run, as "gif" or "mp4", or a "png" of what is looked at."""
        tape = self.tape.until(self.t if kind == "png" else self.world.t)
        return Filming(tape, self.chosen.scene, kind, width)

    # -- time ------------------------------------------------------------------------------------

    def tick(self, dt: float, budget: float = BUDGET) -> list[dict[str, Any]]:
        """Let real time pass.

        Args:
            dt: in s.
            budget: of real time that may go into it, in s.

        Returns:
            lines of the story that are new.
        """
        if self._work is not None:
            self._work_on(2 * budget)  # nothing else moves meanwhile
            return []
        if self.at is not None:
            self._play_on(dt)
            return []
        self._advance(min(dt, _GAP), budget)
        self.hear()
        told, self._lines = self._lines, []
        return told

    def hear(self) -> None:
        """Take in what happened since the last time."""
        self.heard = _heard(self.world, self.experiment, self.tape)
        try:
            self.experiment.passed()
        except CourseError as error:  # the comparison stands, it only could not be kept
            self.news.append(error.message)
        self._lines += self.narrator.tell(self.heard, self.clock())

    def _advance(self, dt: float, budget: float) -> None:
        """Step for this long, but not longer than a frame has time for."""
        world = self.world
        if world.paused or dt <= 0.0:
            return
        left = self.experiment.left()
        stop = dt * world.speed >= left
        if stop:
            dt = left / world.speed
        parts = max(1, math.ceil(dt * world.speed / world.settings["step"] / _CHUNK))
        began, made = self.clock(), parts
        for number in range(1, parts + 1):
            world.advance(dt / parts)
            if self.clock() - began > budget:
                made = number
                break
        if stop and made == parts:
            world.run_until(self.chosen.scene.duration)
        self.pace += 0.1 * (made / parts - self.pace)

    def _play_on(self, dt: float) -> None:
        if self.at is None or not self.way:
            return
        self.at += self.way * min(dt, _GAP) * self.world.speed
        if self.at >= self.world.t:
            self.present()
            self.world.paused = False
        elif self.at <= self.tape.times[0]:
            self.at, self.way = self.tape.times[0], 0

    # -- any moment again ------------------------------------------------------------------------

    def _must_be_idle(self) -> None:
        if self._work is not None:
            raise UsageError("One moment: an earlier one is being made again.", code="busy")

    def _must_be_now(self) -> None:
        self._must_be_idle()
        if self.at is not None:
            raise UsageError(
                f"You look at {self.at:.2f} s. Go on from here, or back to now, and then change it.",
                code="past",
            )

    def _now(self, why: str) -> Moment:
        return Moment(
            self.chosen, self.recording, len(self.recording.inputs), self.world.ticks, self.world.t, why
        )

    def _remember(self, what: str, arguments: tuple[Any, ...], before: Moment) -> None:
        """Undo goes back to before this, unless it goes on with what was done a moment ago."""
        of = arguments[0] if what in {"set", "place", "parameter", "change"} else None
        if what == "change":
            of = arguments[:2]
        same = (what, of) == self._last[:2] and of is not None
        if not (same and 0.0 <= self.world.t - self._last[2] < _TOGETHER):
            self._push(self._undos, before)
        self._redos.clear()
        self._last = (what, of, self.world.t)

    @staticmethod
    def _push(stack: list[Moment], moment: Moment) -> None:
        stack.append(moment)
        del stack[:-_UNDOS]

    def _jump(self, stack: list[Moment], other: list[Moment], which: str) -> None:
        self._must_be_idle()
        if not stack:
            raise UsageError(f"There is nothing to {which}.", code=f"no_{which}")
        self.present()
        if self.world.held:
            self.act("release")
        there = stack[-1]
        now = self._now(there.why)

        def leave() -> None:
            self._push(other, now)
            stack.pop()
            self._last = ("", None, -math.inf)

        self._make(there, f"{which.capitalize()}: {there.why}, at {there.t:.2f} s", leave, paused=True)

    def _make(self, there: Moment, says: str, leave: Callable[[], None], *, paused: bool) -> None:
        """Begin to make a moment again; ``tick`` goes on with it, and calls ``leave`` before it is there."""
        world, recording, inputs = there.recording.begun(there.count, self.world.version + 1)
        tape, narrator = Tape(world, recording), Narrator()
        experiment = Experiment(world, there.chosen, self.experiment.guess, None)
        world.on_input.append(lambda _, what, __: experiment.felt(what))
        tapes = [self.tape] if self.ghost is None else [self.tape, self.ghost]
        shared = [(one, one.shared(there.recording, there.count, there.t - _TOLD)) for one in tapes]
        known, index = max(shared, key=lambda pair: pair[0].times[pair[1]])
        known_until = known.ticks[index] if index else 0

        def halt() -> float:
            """Where the comparison is made, and where what is known from a tape ends."""
            left = experiment.left()
            ends = left if left == math.inf else world.ticks + math.ceil(left / world.settings["step"] - 1e-6)
            return min(ends, known_until if known_until > world.ticks else math.inf)

        def steps() -> Iterator[float]:
            skipping, frames = False, 0
            for share in remade(world, inputs, there.tick, halt):
                # Taking in events books the steps, so it is done with the frames, which do that anyway.
                ended = share == 1.0 or world.ticks == known_until or experiment.left() <= 1e-9
                if ended or len(tape) != frames:
                    narrator.tell(_heard(world, experiment, tape), world.t)
                    experiment.passed()
                    frames = len(tape)
                if skipping and world.ticks == known_until:
                    world.resume(known.sums[index])
                    tape.take_over(known, index)
                    narrator.forget()
                    skipping = False
                elif world.ticks < known_until and not skipping and experiment.left() == math.inf:
                    world.skip()
                    tape.end()
                    skipping = True
                yield share

        def done() -> None:
            leave()
            world.paused, world.speed = paused, self.world.speed
            self.chosen, self.world, self.recording = there.chosen, world, recording
            self.tape, self.experiment, self.narrator = tape, experiment, narrator
            experiment.keep = self.keep
            world.on_input = [recording._note]
            self.present()
            if world.held:
                world.release()
                self.hear()
            tape.take()
            self.anew += 1
            self.news.append(f"{says}.")

        self._work = _Work(steps(), done, says)
        self._work_on(BUDGET)

    def _work_on(self, budget: float) -> None:
        work, began = self._work, self.clock()
        if work is None:
            return
        for share in work.steps:
            work.share = share
            if self.clock() - began > budget:
                return
        self._work = None
        work.done()

    def finish(self) -> None:
        """Wait for what is being made again."""
        while self._work is not None:
            self._work_on(math.inf)


def _heard(world: World, experiment: Experiment, tape: Tape) -> list[Event]:
    """The events since the last time, known to the experiment and marked on the tape."""
    events = world.drain_events()
    experiment.take(events)
    for event in events:
        if event.kind == "contact" and not event.minor:
            tape.mark(event.t)
    return events


def _in_words(what: str, arguments: tuple[Any, ...]) -> str:
    """What is done, in a few words, for undo."""
    first = str(arguments[0]) if arguments else ""
    return {
        "set": f"set {first}",
        "grab": "the hand",
        "throw": "the throw",
        "spawn": f"the new {'ball' if first == 'circle' else first}",
        "place": f"placing {first}",
        "aim": f"aiming {first}",
        "change": f"changing {first}",
        "remove": f"taking {first} away",
        "copy": f"copying {first}",
        "stop": "stopping everything",
        "reset": "the reset",
    }.get(what, what)
