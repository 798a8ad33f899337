"""Recordings: a scene, the user's actions, and enough hashes to say where a replay differs.

One JSON Lines file: a head with the whole scene in it (so that a later edit of the scene cannot change
what is replayed), a line for each thing done by hand, a line with a hash every so many steps, and an end.
"""

from __future__ import annotations

import platform
from typing import TYPE_CHECKING, Any

import msgspec

from course.errors import IntegrityError, NotFoundError, UsageError
from course.sandbox.scene.model import Scene
from course.sandbox.world.engine import versions
from course.sandbox.world.world import World

if TYPE_CHECKING:
    from pathlib import Path

__all__ = ["EVERY", "Difference", "Recording", "Replay", "read", "replay"]

FORMAT = "course.sandbox-recording/1"
#: Steps between two hashes. A hash costs what two steps of a small scene do.
EVERY = 240
#: Steps that a recording may hold; a day at 1/240 s is 20.7 million.
_MOST_TICKS = 100_000_000
#: The methods that a line of a recording may call.
_INPUTS = {"reset", "set", "grab", "drag", "release", "throw", "spawn"}


class Head(msgspec.Struct, frozen=True, kw_only=True, tag_field="kind", tag="head"):
    """The first line."""

    format: str
    scene: Scene
    settings: dict[str, float]
    every: int
    versions: dict[str, str]


class Input(msgspec.Struct, frozen=True, kw_only=True, tag_field="kind", tag="input"):
    """An action of the user, before the step after ``tick``."""

    tick: int
    what: str
    arguments: tuple[str | float, ...] = ()


class Hash(msgspec.Struct, frozen=True, kw_only=True, tag_field="kind", tag="hash"):
    """The state after ``tick`` steps."""

    tick: int
    hash: str


class End(msgspec.Struct, frozen=True, kw_only=True, tag_field="kind", tag="end"):
    """The last line, and the state there."""

    tick: int
    hash: str


Line = Head | Input | Hash | End


class Recording:
    """Records what happens to a world, from its first step on.

    Args:
        world: before its first step.
        every: steps between two hashes.
    """

    def __init__(self, world: World, every: int = EVERY) -> None:
        if world.ticks:
            raise UsageError("A recording has to begin before the first step.")
        self._world = world
        self._lines: list[Line] = [
            Head(
                format=FORMAT,
                scene=world.scene,
                settings=dict(world.settings),
                every=every,
                versions=_versions(),
            )
        ]
        self._every = every
        world.on_input = self._note
        world.on_tick = (every, self._hash)

    def encode(self) -> bytes:
        """The file, up to the present step."""
        world = self._world
        end = End(tick=world.ticks, hash=world.state_hash())
        return b"".join(msgspec.json.encode(line) + b"\n" for line in (*self._lines, end))

    def _note(self, tick: int, what: str, arguments: tuple[Any, ...]) -> None:
        last = self._lines[-1]
        if what == "drag" and isinstance(last, Input) and last.what == "drag" and last.tick == tick:
            self._lines.pop()  # only the last place before a step is ever felt
        self._lines.append(Input(tick=tick, what=what, arguments=arguments))

    def _hash(self) -> None:
        self._lines.append(Hash(tick=self._world.ticks, hash=self._world.state_hash()))


class Replay(msgspec.Struct, frozen=True, kw_only=True):
    """A recording that was read."""

    head: Head
    inputs: tuple[Input, ...]
    hashes: tuple[Hash | End, ...]

    @property
    def ticks(self) -> int:
        return self.hashes[-1].tick


class Difference(msgspec.Struct, frozen=True, kw_only=True):
    """How a replay went.

    Attributes:
        same: every hash was the recorded one.
        tick: the first step count at which they differ; None if they do not.
        good_until: the last one at which they still agreed.
        t: simulated time at ``tick``, in s.
        checked: hashes compared.
        versions: parts whose recorded version differs from the one here: (recorded, here).
    """

    same: bool
    tick: int | None
    good_until: int
    t: float | None
    checked: int
    versions: dict[str, tuple[str, str]]


def read(path: Path) -> Replay:
    """A recording.

    Raises:
        NotFoundError: there is no such file.
        UsageError: it is not a recording, or has a newer format.
        IntegrityError: it is damaged, or has no end.
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        reason = error.strerror or error
        raise NotFoundError(
            f"{path} cannot be read ({reason}).", help="Name a recording.", code="recording_not_found"
        ) from error
    lines = data.splitlines()
    decoder: msgspec.json.Decoder[Line] = msgspec.json.Decoder(Line)
    decoded: list[Line] = []
    for number, line in enumerate(lines, 1):
        try:
            decoded.append(decoder.decode(line))
        except msgspec.DecodeError as error:
            if number == 1:
                raise UsageError(f"{path} is not a recording: {error}.", code="bad_recording") from error
            raise IntegrityError(f"{path}:{number} is damaged: {error}.", code="damaged_recording") from error
    return _checked(path, decoded)


def replay(recorded: Replay) -> Difference:
    """Repeat everything, and compare."""
    here = _versions()
    then = recorded.head.versions
    other = {
        name: (then.get(name, "?"), here.get(name, "?"))
        for name in sorted({*then, *here})
        if then.get(name) != here.get(name)
    }
    world = World(recorded.head.scene, recorded.head.settings, receipt=False)
    inputs = list(recorded.inputs)[::-1]
    good = 0
    for checked, point in enumerate(recorded.hashes, 1):
        while inputs and (inputs[-1].tick < point.tick or isinstance(point, End)):
            step = inputs.pop()
            world.step(step.tick - world.ticks)
            _act(world, step)
        world.step(point.tick - world.ticks)
        if world.state_hash() != point.hash:
            return Difference(
                same=False, tick=point.tick, good_until=good, t=world.t, checked=checked, versions=other
            )
        good = point.tick
    count = len(recorded.hashes)
    return Difference(same=True, tick=None, good_until=good, t=None, checked=count, versions=other)


def _act(world: World, step: Input) -> None:
    try:
        getattr(world, step.what)(*step.arguments)
    except TypeError as error:
        raise IntegrityError(
            f"The recording is damaged: {step.what} at step {step.tick} has the wrong values.",
            code="damaged_recording",
        ) from error


def _checked(path: Path, lines: list[Line]) -> Replay:
    """The lines as a recording, if they are one."""
    head = lines[0] if lines else None
    if not isinstance(head, Head) or head.format != FORMAT:
        form = head.format if isinstance(head, Head) else "nothing"
        raise UsageError(
            f"{path} is not a recording that this program knows (it begins with {form[:40]}).",
            help="Record one with `course sandbox play SCENE --record FILE`.",
            code="bad_recording",
        )
    if not isinstance(lines[-1], End):
        raise IntegrityError(f"{path} has no end; it was cut off.", code="damaged_recording")
    inputs = tuple(line for line in lines if isinstance(line, Input))
    hashes = tuple(line for line in lines if isinstance(line, Hash | End))
    ticks = [line.tick for line in lines[1:] if not isinstance(line, Head)]
    ends = sum(isinstance(line, End) for line in lines)
    if len(ticks) < len(lines) - 1 or ends > 1 or ticks != sorted(ticks) or ticks[0] < 0:
        raise IntegrityError(f"{path}: its steps are out of order.", code="damaged_recording")
    unknown = {line.what for line in inputs} - _INPUTS
    if unknown or lines[-1].tick > _MOST_TICKS:
        raise IntegrityError(f"{path} asks for what no recording holds.", code="damaged_recording")
    return Replay(head=head, inputs=inputs, hashes=hashes)


def _versions() -> dict[str, str]:
    """Versions that the bits depend on: the engine, the machine it was built for, and this course."""
    from course import __version__

    machine = f"{platform.system()} {platform.machine()}"
    return {**versions(), "course": __version__, "machine": machine}
