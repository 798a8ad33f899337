"""The history of a run: frames of what became of a world, beside the recording of what was done to it.

What was done is exact: from it any moment is made again, to the last bit. Frames are for the eye: they show
any moment at once.
"""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from collections.abc import Callable
from threading import Thread
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from course.errors import CourseError, UsageError
from course.sandbox.runs.recording import Film, Recording, ffmpeg
from course.sandbox.scene.loading import Chosen
from course.sandbox.scene.model import Part, Scene
from course.sandbox.world.accounts import Receipt
from course.sandbox.world.world import Snapshot, World

#: Pictures a second of a film; a run that is over sooner than so many s is filmed in slow motion.
FILM_FPS, _LEAST = 25.0, 2.0

Frame: TypeAlias = NDArray[np.float32]

#: Numbers in front of the bodies of a frame; ``camera.js`` has the same.
HEAD = 24
#: What samples hold of them, in s, J, kg m/s and kg m²/s, and where in a frame that is.
SAMPLED = ("t", "kinetic", "potential", "contacts", "friction", "rods", "residual", "px", "py", "angular")
_SAMPLED_AT = [2, *range(11, 20)]
#: Samples of the last so many s are given, and so many of them at most.
_MINUTE, _MOST_SAMPLES = 60.0, 3600
#: Of each body: x, y, angle, vx, vy.
PER_BODY = 5
#: Between two frames, in simulated s; of a run that is over in a moment, this part of it.
_EVERY, _PART = 1 / 60, 1 / 240
#: Bytes that frames may hold (there is a ghost as well), and frames that are kept whole: ten minutes of them.
_BYTES, _WHOLE = 140_000_000, 36_000


def frame(world: World, pace: float = 1.0, number: int = 0) -> Frame:
    """Where everything is, (HEAD + 5 bodies + 4 joints,).

    ``HEAD`` numbers: 1, version, t, pace, bodies, joints, whether a body is held, the four of the hand,
    kinetic, potential, contacts, friction, rods, residual, momentum x and y, angular momentum, row of the
    body that is held or -1, number of the world, start + given, and 1 if it is of the past. Then x, y, angle,
    vx, vy of each body, then the two ends of each joint.

    Args:
        pace: simulated seconds per second that were really made, as a part of those asked for.
        number: of the world, where there are several.
    """
    shot, receipt, (px, py, angular) = world.snapshot(), world.receipt, world.momentum
    held = world.held
    row = next((i for i, part in enumerate(world.parts) if part.name == held), -1) if held else -1
    energies = receipt.kinetic, receipt.potential, receipt.contacts, receipt.friction, receipt.rods
    head = [1.0, shot.version, shot.t, pace, len(shot.x), len(shot.joints), shot.hand is not None]
    head += [*(shot.hand or (0.0,) * 4), *energies, receipt.residual]
    head += [px, py, angular, row, number, receipt.start + receipt.given, 0.0]
    bodies = np.stack([shot.x, shot.y, shot.angle, shot.vx, shot.vy], axis=1)
    # What does not fit a float32 becomes infinite, which nobody draws.
    with np.errstate(over="ignore"):
        return np.concatenate([np.array(head), bodies.ravel(), shot.joints.ravel()]).astype("<f4")


def shot_of(kept: Frame) -> Snapshot:
    """A frame as what is drawn."""
    numbers = kept.astype(np.float64)
    count, joints = int(kept[4]), int(kept[5])
    x, y, angle, vx, vy = numbers[HEAD : HEAD + PER_BODY * count].reshape(-1, PER_BODY).T
    ends = numbers[HEAD + PER_BODY * count :][: 4 * joints].reshape(-1, 4)
    hand = (numbers[7], numbers[8], numbers[9], numbers[10]) if kept[6] else None
    return Snapshot(float(kept[2]), int(kept[1]), x, y, angle, vx, vy, ends, hand)


def account_of(kept: Frame, start: float) -> tuple[Receipt, tuple[float, float, float]]:
    """What a frame says of energy and momentum; ``start`` is the run's energy at time 0, in J."""
    sample = dict(zip(SAMPLED, kept[_SAMPLED_AT].tolist(), strict=True))
    px, py, angular = (sample.pop(name) for name in ("px", "py", "angular"))
    del sample["t"]
    given = float(kept[22]) - start
    if abs(given) <= 1e-6 * abs(start):  # the frame's numbers have seven digits
        given = 0.0
    # A frame does not have the integrator's part of what is missing.
    return Receipt(start=start, given=given, integrator=0.0, **sample), (px, py, angular)


class Tape:
    """Frames of a world's present run.

    Attributes:
        frames, times, ticks, sums: the frames, with the simulated time in s, the step and the sums of the
            account of each.
        casts: the bodies, by the version that a frame names.
        marks: times of the contacts that are worth a mark, in s.
    """

    def __init__(self, world: World, recording: Recording) -> None:
        self.recording = recording
        self.sums: list[tuple[float, ...]] = []
        self.frames: list[Frame] = []
        self.times: list[float] = []
        self.ticks: list[int] = []
        self.casts: dict[int, tuple[Part, ...]] = {}
        self.marks: list[float] = []
        self._world = world
        self._bytes = 0
        self._rule: tuple[int, Callable[[], None]] = (0, self.take)
        self.pace_itself()
        self.take()

    def __len__(self) -> int:
        return len(self.frames)

    def pace_itself(self) -> None:
        """Take a frame every so many steps, as the step's size is now."""
        world = self._world
        self.end()
        gap = min(_EVERY, world.scene.duration * _PART)
        self._rule = max(1, round(gap / world.settings["step"])), self.take
        world.on_tick.append(self._rule)

    def end(self) -> None:
        """Keep no more."""
        if self._rule in self._world.on_tick:
            self._world.on_tick.remove(self._rule)

    def take(self) -> None:
        """Keep the present moment; again at the same step replaces what was kept."""
        world = self._world
        if self.ticks and self.ticks[-1] == world.ticks:
            self._bytes -= self.frames.pop().nbytes
            for kept in (self.times, self.ticks, self.sums):
                kept.pop()
        shown = frame(world)
        shown[23] = 1.0
        self.frames.append(shown)
        self.sums.append(world.sums)
        self.times.append(world.t)
        self.ticks.append(world.ticks)
        self.casts[world.version] = world.parts
        self._bytes += shown.nbytes
        if self._bytes > _BYTES or len(self.frames) > 2 * _WHOLE:
            self._thin()

    def at(self, t: float) -> int:
        """The frame that shows this time, as an index: the last that is not after it."""
        return max(0, bisect_right(self.times, t + 1e-9) - 1)

    def frame_at(self, t: float) -> Frame:
        """Where everything was at this time."""
        return self.frames[self.at(t)]

    def samples(self, after: float = -math.inf, until: float = math.inf) -> Frame:
        """Energies and momenta later than ``after`` and up to ``until``, in s; a row as ``SAMPLED`` says.

        They go back a minute.
        """
        end = bisect_right(self.times, until + 1e-9)
        begin = bisect_right(self.times, max(after, self.times[max(0, end - 1)] - _MINUTE))
        kept = self.frames[begin:end]
        heads = [one[:HEAD] for one in kept[:: len(kept) // _MOST_SAMPLES + 1]]
        return np.array(heads, dtype="<f4").reshape(-1, HEAD)[:, _SAMPLED_AT]

    def path(self, name: str, most: int = 1500) -> Frame:
        """Where a body was and when, (k, 3): t, x, y, in s and m; at most so many places."""
        rows = {
            version: row
            for version, cast in self.casts.items()
            for row, part in enumerate(cast)
            if part.name == name
        }
        places = [
            (one[2], *one[HEAD + PER_BODY * rows[int(one[1])] :][:2])
            for one in self.frames[:: len(self.frames) // most + 1]
            if int(one[1]) in rows
        ]
        return np.array(places, dtype="<f4").reshape(-1, 3)

    def film(self, scene: Scene, kind: str, width: int, told: Callable[[float], bool]) -> bytes:
        """This run as a film, or its last part, if it is long; or the moment of its last frame as a picture.

        Args:
            kind: "gif", "mp4" or "png".
            told: is told how far it is, 0 to 1, and answers whether to go on.

        Raises:
            UsageError: it was stopped.
            MissingCapabilityError: this machine cannot make one.
        """
        reel = Film(scene, width)
        if kind == "mp4":
            ffmpeg()
        if kind == "png":
            return reel.png(self.casts[int(self.frames[-1][1])], shot_of(self.frames[-1]))
        slow = max(1.0, _LEAST / max(self.times[-1], 1e-9))
        count = int(self.times[-1] * slow * FILM_FPS) + 1
        first = max(0, count - reel.room(kind))
        for number in range(first, count):
            one = self.frames[self.at(number / FILM_FPS / slow)]
            reel.take(self.casts[int(one[1])], shot_of(one))
            if not told((number + 1 - first) / (count + 1 - first)):
                raise UsageError("The film was stopped.", code="stopped")
        return reel.gif(FILM_FPS) if kind == "gif" else reel.mp4(FILM_FPS)

    def mark(self, t: float) -> None:
        """A contact, if it is far enough from the last one to be a mark of its own."""
        gap = max(0.004, self.times[-1] / 2000)
        if not self.marks or t - self.marks[-1] >= gap:
            self.marks.insert(bisect_left(self.marks, t), t)

    def _thin(self) -> None:
        """Of the older half every other frame goes."""
        half = len(self.frames) // 2 // 2 * 2
        for kept in (self.frames, self.times, self.ticks, self.sums):
            del kept[1:half:2]
        self._bytes = sum(one.nbytes for one in self.frames)

    def shared(self, there: Recording, count: int, before: float) -> int:
        """The last frame that shows what the first inputs of another recording lead to as well, as an index.

        Args:
            there: the other one, and how many of its inputs count.
            before: the latest time, in s.
        """
        inputs, run = there.inputs[:count], there.run_at(count)[0]
        began, mine = inputs[run - 1].tick if run else 0, self.recording.inputs
        if self.ticks[0] != began or self.recording.head != there.head:
            return 0
        same = next((i for i, pair in enumerate(zip(inputs, mine, strict=False)) if pair[0] != pair[1]), None)
        same = min(len(inputs), len(mine)) if same is None else same
        ends = [one.tick for rest in (inputs[same:], mine[same:]) for one in rest[:1]]
        index, acts = self.at(before), {one.tick for one in inputs}
        while index > 0 and (self.ticks[index] >= min(ends, default=math.inf) or self.ticks[index] in acts):
            index -= 1
        return index

    def take_over(self, other: Tape, index: int) -> None:
        """Have the frames of another tape up to this one for those after one's own, and go on."""
        since = bisect_right(other.ticks, self.ticks[-1])
        new = slice(since, index + 1)
        self.frames += other.frames[new]
        self.times += other.times[new]
        self.ticks += other.ticks[new]
        self.sums += other.sums[new]
        self.casts = other.casts | self.casts
        marks = other.marks
        self.marks += marks[bisect_right(marks, other.times[since - 1]) : bisect_right(marks, self.times[-1])]
        self._bytes = sum(one.nbytes for one in self.frames)
        self.pace_itself()

    def until(self, t: float) -> Tape:
        """A tape of the frames up to this time, which nothing is added to."""
        kept: Tape = object.__new__(Tape)
        count = self.at(t) + 1
        kept.frames, kept.times, kept.ticks = self.frames[:count], self.times[:count], self.ticks[:count]
        kept.casts, kept.marks = dict(self.casts), []
        return kept


class Filming:
    """A film of a tape in the making, beside the world.

    Attributes:
        share: how far it is, 0 to 1.
        stopped: give it up.
        data: the file, once it no longer ``running``.
        failed: why there is none.
    """

    def __init__(self, tape: Tape, scene: Scene, kind: str, width: int) -> None:
        room = Film(scene, width).room(kind) / FILM_FPS
        part = f"-last-{room:.0f}-s" if kind != "png" and tape.times[-1] > room else ""
        self.name, self.share, self.stopped = f"{scene.id}{part}.{kind}", 0.0, False
        self.data, self.failed = b"", ""
        self._thread = Thread(target=self._make, args=(tape, scene, kind, width), daemon=True)
        self._thread.start()

    @property
    def running(self) -> bool:
        """It is not ready yet."""
        return self._thread.is_alive()

    def wait(self, seconds: float) -> None:
        """Until it is ready, but no longer."""
        self._thread.join(seconds)

    def _make(self, tape: Tape, scene: Scene, kind: str, width: int) -> None:
        try:
            self.data = tape.film(scene, kind, width, self._told)
        except CourseError as error:
            self.failed = f"{error.message} {error.help or ''}".strip()

    def _told(self, share: float) -> bool:
        self.share = share
        return not self.stopped


#: Frames of a preview, and the simulated time they show at most, in s.
_PREVIEW, _LOOP = 60, 3.0


def preview(chosen: Chosen) -> tuple[tuple[Part, ...], Frame, Frame]:
    """A scene for a card: its bodies; x, y and angle of each, (frames, n, 3); its joints, (frames, m, 4)."""
    world = World(chosen.scene, chosen.settings, receipt=False)
    length = min(chosen.scene.duration, _LOOP)
    cast: dict[str, Part] = {}
    shots: list[tuple[dict[str, int], Snapshot]] = []
    for number in range(_PREVIEW):
        world.run_until(number * length / _PREVIEW)
        cast.update((part.name, part) for part in world.parts)
        shots.append(({part.name: row for row, part in enumerate(world.parts)}, world.snapshot()))
        world.drain_events()
    places = np.full((_PREVIEW, len(cast), 3), np.nan, dtype="<f4")
    joints = np.zeros((_PREVIEW, len(shots[0][1].joints), 4), dtype="<f4")
    for number, (rows, shot) in enumerate(shots):
        here = [i for i, name in enumerate(cast) if name in rows]
        there = [rows[name] for name in cast if name in rows]
        places[number, here] = np.stack([shot.x, shot.y, shot.angle], axis=1)[there]
        joints[number, : len(shot.joints)] = shot.joints
    return tuple(cast.values()), places, joints
