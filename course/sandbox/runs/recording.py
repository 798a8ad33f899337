"""Recordings: a scene, the user's actions, and enough hashes to say where a replay differs.

One JSON Lines file: a head with the whole scene in it (so that a later edit of the scene cannot change
what is replayed), a line for each thing done by hand, a line with a hash every so many steps, and an end.
"""

from __future__ import annotations

import contextlib
import io
import math
import platform
import shutil
import subprocess
import zlib
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, assert_never, cast

import msgspec

from course.catalog.reading import Document, LineMap
from course.errors import ContentError, IntegrityError, MissingCapabilityError, NotFoundError, UsageError
from course.sandbox.scene.model import Form, Part, Scene, Vector
from course.sandbox.scene.rules import check_scene
from course.sandbox.world.engine import versions
from course.sandbox.world.world import Snapshot, World
from course.strangers import read_bytes

if TYPE_CHECKING:
    from PIL.Image import Image
    from PIL.ImageDraw import ImageDraw


FORMAT = "course.sandbox-recording/1"
#: Steps between two hashes. A hash costs what two steps of a small scene do.
EVERY = 240
#: Steps between two looks at the clock when a moment is made again.
_SLICE = 16
#: Steps that a recording may hold; a day at 1/240 s is 20.7 million.
_MOST_TICKS = 100_000_000
#: The methods that a line of a recording may call.
_INPUTS = {
    *("reset", "set", "grab", "drag", "release", "throw", "spawn"),
    *("place", "aim", "change", "remove", "copy", "stop"),
}


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
        head: that of the recording that is gone on with, if the world stands in for another one.

    Attributes:
        head: the scene and the settings that it began with.
        inputs, hashes: in the order of their steps; nothing in them is ever changed, so others may remember
            how long they were.
    """

    def __init__(self, world: World, every: int = EVERY, head: Head | None = None) -> None:
        if world.ticks and head is None:
            raise UsageError("A recording has to begin before the first step.")
        self._world = world
        settings = dict(world.settings)
        self.head = head or Head(
            format=FORMAT, scene=world.scene, settings=settings, every=every, versions=_versions()
        )
        self.inputs: list[Input] = []
        self.hashes: list[Hash] = []
        world.on_input.append(self._note)
        world.on_tick.append((self.head.every, self._hash))

    def encode(self) -> bytes:
        """The file, up to the present step."""
        world = self._world
        end = End(tick=world.ticks, hash=world.state_hash())
        # What is done at a step comes after the hash of it.
        lines: list[Input | Hash] = [*self.hashes, *self.inputs]
        lines.sort(key=lambda line: (line.tick, isinstance(line, Input)))
        return b"".join(msgspec.json.encode(line) + b"\n" for line in (self.head, *lines, end))

    def _note(self, tick: int, what: str, arguments: tuple[Any, ...]) -> None:
        last = self.inputs[-1] if self.inputs else None
        if what == "drag" and last is not None and last.what == "drag" and last.tick == tick:
            self.inputs.pop()  # only the last place before a step is ever felt
        self.inputs.append(Input(tick=tick, what=what, arguments=arguments))

    def _hash(self) -> None:
        self.hashes.append(Hash(tick=self._world.ticks, hash=self._world.state_hash()))

    # -- any moment again ------------------------------------------------------------------------

    def run_at(self, count: int) -> tuple[int, dict[str, float]]:
        """The run that the first ``count`` inputs end in.

        Returns:
            how many of them are before it, and the settings that it started with.
        """
        settings, first, began = dict(self.head.settings), 0, dict(self.head.settings)
        for number, one in enumerate(self.inputs[:count], 1):
            if one.what == "set":
                settings[str(one.arguments[0])] = float(one.arguments[1])
            elif one.what == "stop" and "left" in settings:
                settings |= {"left": 0.0, "right": 0.0}
            elif one.what == "reset":
                first, began = number, dict(settings)
        return first, began

    def begun(self, count: int, version: int) -> tuple[World, Recording, list[Input]]:
        """The run that the first ``count`` inputs end in, in a world of its own before its first step.

        Args:
            version: the first for the new world.

        Returns:
            the world, its recording, and those of the inputs that belong to this run.
        """
        first, settings = self.run_at(count)
        world = World(self.head.scene, settings)
        began = self.inputs[first - 1].tick if first else 0
        world.ticks, world.version = began, version
        made = Recording(world, head=self.head)
        made.inputs = self.inputs[:first]
        made.hashes = [one for one in self.hashes if one.tick <= began]
        return world, made, self.inputs[first:count]


def remade(world: World, inputs: Sequence[Input], tick: int, halt: Callable[[], float]) -> Iterator[float]:
    """Do all of this again, and step on until ``tick``.

    Args:
        halt: tells the next step after which it has to yield.

    Yields:
        how far it is, 0 to 1, every few steps.
    """
    began = world.ticks
    for one in [*inputs, None]:
        until = tick if one is None else one.tick
        while world.ticks < until:
            world.step(int(min(_SLICE, until - world.ticks, max(1, halt() - world.ticks))))
            yield (world.ticks - began) / max(1, tick - began)
        if one is not None:
            act(world, one)
    yield 1.0


class Replay(msgspec.Struct, frozen=True, kw_only=True):
    """A recording that was read."""

    path: Path
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


#: What to do about a file that is no recording, and about a damaged one.
_RECORD = "Record one with `course sandbox play SCENE --record FILE`."
_AGAIN = "Take a copy of it, or record it again: `course sandbox play SCENE --record FILE`."


def read(path: Path) -> Replay:
    """A recording.

    Raises:
        NotFoundError: there is no such file.
        UsageError: it is not a recording, or has a newer format.
        IntegrityError: it is damaged, or has no end.
    """
    try:
        data = read_bytes(path)
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
        except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
            if number == 1:
                problem = f"{path} is not a recording: its first line is not that of one."
                raise UsageError(problem, help=_RECORD, code="bad_recording") from error
            problem = f"{path}:{number} is damaged: the file was cut off there, or changed."
            raise IntegrityError(problem, help=_AGAIN, code="damaged_recording") from error
    return _checked(path, decoded)


def replay(recorded: Replay) -> Difference:
    """Repeat everything, and compare.

    Raises:
        CourseError: something that was recorded cannot be done.
    """
    here = _versions()
    then = recorded.head.versions
    other = {
        name: (then.get(name, "?"), here.get(name, "?"))
        for name in sorted({*then, *here})
        if then.get(name) != here.get(name)
    }
    try:
        check_scene(Document(recorded.path, recorded.head.scene, LineMap("")))
    except ContentError as error:
        raise IntegrityError(
            f"{recorded.path}:1 is damaged: in its scene, {error.problem}", code="damaged_recording"
        ) from error
    world = World(recorded.head.scene, recorded.head.settings, receipt=False)
    inputs = list(recorded.inputs)[::-1]
    good = 0
    for checked, point in enumerate(recorded.hashes, 1):
        while inputs and (inputs[-1].tick < point.tick or isinstance(point, End)):
            step = inputs.pop()
            world.step(step.tick - world.ticks)
            try:
                act(world, step)
            except UsageError as error:
                raise UsageError(
                    f"{recorded.path} cannot do {step.what!r} before step {step.tick + 1}: {error.message}",
                    help="Replay the file as it was recorded.",
                    code=error.code,
                ) from error
        world.step(point.tick - world.ticks)
        if world.state_hash() != point.hash:
            return Difference(
                same=False, tick=point.tick, good_until=good, t=world.t, checked=checked, versions=other
            )
        good = point.tick
    count = len(recorded.hashes)
    return Difference(same=True, tick=None, good_until=good, t=None, checked=count, versions=other)


def act(world: World, step: Input) -> None:
    """Do again what was done."""
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
        form = f"it begins with {head.format[:40]}" if isinstance(head, Head) else "its first line is no head"
        raise UsageError(
            f"{path} is not a recording that this program knows ({form}).",
            help=_RECORD,
            code="bad_recording",
        )
    if not isinstance(lines[-1], End):
        problem = f"{path} has no end; it was cut off."
        raise IntegrityError(problem, help=_AGAIN, code="damaged_recording")
    inputs = tuple(line for line in lines if isinstance(line, Input))
    hashes = tuple(line for line in lines if isinstance(line, Hash | End))
    ticks = [line.tick for line in lines[1:] if not isinstance(line, Head)]
    ends = sum(isinstance(line, End) for line in lines)
    if len(ticks) < len(lines) - 1 or ends > 1 or ticks != sorted(ticks) or ticks[0] < 0:
        problem = f"{path}: its steps are out of order."
        raise IntegrityError(problem, help=_AGAIN, code="damaged_recording")
    unknown = {line.what for line in inputs} - _INPUTS
    hashed = max((line.tick for line in hashes[:-1]), default=0)
    # A run that goes on for long behind its last hash is not one that was recorded.
    if unknown or lines[-1].tick > min(hashed + max(head.every, 1), _MOST_TICKS):
        problem = f"{path} asks for what no recording holds."
        raise IntegrityError(problem, help=_AGAIN, code="damaged_recording")
    return Replay(path=path, head=head, inputs=inputs, hashes=hashes)


def _versions() -> dict[str, str]:
    """Versions that the bits depend on: the engine, the machine it was built for, and this course."""
    from course import __version__

    machine = f"{platform.system()} {platform.machine()}"
    return {**versions(), "course": __version__, "machine": machine}


# ---
# Frames drawn with PIL: a GIF, an MP4 where ffmpeg is there, or one picture.
#
# Drawn at twice the size and scaled down, because PIL draws hard edges. A GIF has one palette for all frames,
# made of the scene's own colours, so no frame has to be analysed and none flickers.


_PAPER = "#ffffff"
_INK = "#222222"
_MOST_FRAMES = 3000
#: Of the frames of a GIF of a run, unpacked.
_GIF_BYTES = 700_000_000
#: Longest side of a picture, in pixels.
_LARGEST = 1920


def ffmpeg() -> str:
    """Where ffmpeg is.

    Raises:
        MissingCapabilityError: it is not installed.
    """
    found = shutil.which("ffmpeg")
    if found is None:
        raise MissingCapabilityError(
            "An MP4 needs ffmpeg, which is not on this machine.",
            help="Install ffmpeg with the system's packages (apt, brew, winget), or save a GIF.",
            code="no_ffmpeg",
        )
    return found


class Film:
    """Collects frames of one run.

    Args:
        width: of a frame in pixels; its height follows from the view.
    """

    def __init__(self, scene: Scene, width: int = 480) -> None:
        left, bottom, right, top = scene.view
        if not 64 <= width <= _LARGEST:
            raise UsageError(f"A frame may be 64 to {_LARGEST} pixels wide, not {width}.", code="bad_size")
        height = min(_LARGEST, max(32, round(width * (top - bottom) / (right - left))))
        # Video encoders want even sides.
        self.size = (width - width % 2, height - height % 2)
        self._scale = 2 * self.size[0] / (right - left)
        self._origin = left, top
        #: Packed: most of a frame is paper, and a thousand large ones fit into any memory.
        self._frames: list[bytes] = []
        self._palette: Image | None = None
        #: What does not move, drawn once for each cast of bodies.
        self._still: tuple[int, Image] | None = None

    def __len__(self) -> int:
        return len(self._frames)

    def take(self, parts: tuple[Part, ...], snapshot: Snapshot) -> None:
        """Draw one frame.

        Raises:
            UsageError: the film is too long.
        """
        if len(self._frames) >= _MOST_FRAMES:
            raise UsageError(
                f"A film has at most {_MOST_FRAMES} frames.",
                help="Give a shorter --duration.",
                code="too_long",
            )
        self._frames.append(zlib.compress(self._reduced(self.draw(parts, snapshot), parts).tobytes(), 1))

    def draw(self, parts: tuple[Part, ...], snapshot: Snapshot) -> Image:
        """One picture in full colour."""
        from PIL import Image as Images
        from PIL import ImageDraw

        if self._still is None or self._still[0] != snapshot.version:
            ground = Images.new("RGB", (2 * self.size[0], 2 * self.size[1]), _PAPER)
            self._draw_parts(ImageDraw.Draw(ground), parts, snapshot, fixed=True)
            self._still = snapshot.version, ground
        large = self._still[1].copy()
        pen = ImageDraw.Draw(large)
        self._draw_parts(pen, parts, snapshot, fixed=False)
        for ax, ay, bx, by in snapshot.joints.tolist():
            pen.line([self._at(ax, ay), self._at(bx, by)], fill=_INK, width=4)
        picture = large.reduce(2)
        ImageDraw.Draw(picture).text((6, 4), f"{snapshot.t:.2f} s", fill=_INK)
        return picture

    def gif(self, fps: float = 25.0) -> bytes:
        """The film as an animated GIF that repeats."""
        # The format counts hundredths of a second.
        pause = max(2, round(100.0 / fps)) * 10
        frames = self._some()
        data = io.BytesIO()
        next(frames).save(
            data,
            format="GIF",
            save_all=True,
            append_images=frames,
            duration=pause,
            loop=0,
            optimize=False,
            disposal=1,
        )
        return data.getvalue()

    def mp4(self, fps: float = 25.0) -> bytes:
        """The film as an MP4 that every browser plays.

        Raises:
            MissingCapabilityError: there is no ffmpeg, or it cannot encode H.264.
        """
        import tempfile

        command = [ffmpeg(), "-v", "error", "-f", "rawvideo", "-pix_fmt", "rgb24"]
        command += ["-s", f"{self.size[0]}x{self.size[1]}", "-r", f"{fps:g}", "-i", "-"]
        command += ["-c:v", "libx264", "-pix_fmt", "yuv420p", "-movflags", "+faststart", "-y"]
        with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryFile() as said:
            out = Path(folder) / "film.mp4"
            with subprocess.Popen([*command, str(out)], stdin=subprocess.PIPE, stderr=said) as running:
                with contextlib.suppress(OSError):  # it stopped reading, and says why
                    for frame in self._some():
                        cast("IO[bytes]", running.stdin).write(frame.convert("RGB").tobytes())
                with contextlib.suppress(OSError):
                    running.communicate()
            if running.returncode or not out.is_file():
                said.seek(0)
                lines = said.read().decode(errors="replace").strip().splitlines()
                raise MissingCapabilityError(
                    f"ffmpeg could not make the film: {lines[-1] if lines else 'it said nothing'}.",
                    help="Write a --gif instead.",
                    code="ffmpeg_failed",
                )
            return out.read_bytes()

    def png(self, parts: tuple[Part, ...], snapshot: Snapshot) -> bytes:
        """One picture."""
        data = io.BytesIO()
        self.draw(parts, snapshot).save(data, format="PNG")
        return data.getvalue()

    def room(self, kind: str) -> int:
        """Frames that fit into a film; PIL has all of a GIF in memory at once."""
        width, height = self.size
        return _MOST_FRAMES if kind == "mp4" else min(_MOST_FRAMES, _GIF_BYTES // (width * height))

    def _some(self) -> Iterator[Image]:
        from PIL import Image as Images

        if self._palette is None:
            raise UsageError("There is no frame to make a film of.", code="no_frames")
        for packed in self._frames:
            image = Images.frombytes("P", self.size, zlib.decompress(packed))
            image.putpalette(self._palette.getpalette() or [])
            yield image

    def _draw_parts(self, pen: ImageDraw, parts: tuple[Part, ...], shot: Snapshot, *, fixed: bool) -> None:
        places = zip(parts, shot.x.tolist(), shot.y.tolist(), shot.angle.tolist(), strict=True)
        for part, x, y, angle in places:
            if part.fixed == fixed:
                self._draw_part(pen, part, x, y, angle)

    def _draw_part(self, pen: ImageDraw, part: Part, x: float, y: float, angle: float) -> None:
        c, s = math.cos(angle), math.sin(angle)
        corners = [self._at(x + c * px - s * py, y + s * px + c * py) for px, py in part.outline]
        centre, r = self._at(x, y), part.radius * self._scale
        draw_body(pen, part.shape, corners, centre, r, fill=part.colour, outline=_INK, width=2)
        if part.shape == "circle" and not part.fixed:  # a mark, so that turning is seen
            pen.line([centre, (centre[0] + r * c, centre[1] - r * s)], fill=_INK, width=2)
        if part.wheels is not None:
            for side in (0.5, -0.5):
                px, py = self._at(x - s * side * part.wheels.track, y + c * side * part.wheels.track)
                dx, dy = 0.06 * self._scale * c, -0.06 * self._scale * s
                pen.line([(px - dx, py - dy), (px + dx, py + dy)], fill=_INK, width=8)

    def _at(self, x: float, y: float) -> tuple[float, float]:
        """A place in pixels of the large picture; far outside it is cut, which PIL needs."""
        px = (x - self._origin[0]) * self._scale
        py = (self._origin[1] - y) * self._scale
        return min(max(px, -1e4), 1e4), min(max(py, -1e4), 1e4)

    def _reduced(self, picture: Image, parts: tuple[Part, ...]) -> Image:
        """A frame in the film's own 256 colours."""
        from PIL import Image as Images

        if self._palette is None:
            self._palette = _palette({part.colour for part in parts})
        return picture.quantize(palette=self._palette, dither=Images.Dither.NONE)


def draw_body(
    pen: ImageDraw, shape: Form, corners: Sequence[Vector], centre: Vector, grown: float, **ink: Any
) -> None:
    """Draw a body.

    Args:
        corners, centre: in pixels.
        grown: how far beyond its corners or its centre it reaches, in pixels.
        ink: ``fill``, and perhaps ``outline`` and ``width``.
    """
    match shape:
        case "circle":
            x, y = centre
            pen.ellipse((x - grown, y - grown, x + grown, y + grown), **ink)
        case "segment":
            pen.line(corners, fill=ink["fill"], width=max(2, round(2 * grown)))
        case "polygon":
            pen.polygon(corners, **ink)
            if grown:
                pen.line([*corners, corners[0]], fill=ink["fill"], width=round(2 * grown))
        case _:
            assert_never(shape)


def _palette(colours: set[str]) -> Image:
    """Each colour, and its way to paper and to ink in steps, for smooth edges."""
    from PIL import Image as Images
    from PIL import ImageColor

    paper, ink = ImageColor.getrgb(_PAPER)[:3], ImageColor.getrgb(_INK)[:3]
    wanted: list[tuple[int, ...]] = [paper, ink]
    steps = max(2, min(8, 120 // (len(colours) + 1)))
    for colour in [_INK, *sorted(colours)]:
        own = ImageColor.getrgb(colour)[:3]
        for end in (paper, ink):
            pairs = list(zip(own, end, strict=True))
            wanted += [tuple(round(a + (b - a) * k / steps) for a, b in pairs) for k in range(steps)]
    image = Images.new("P", (1, 1))
    flat = [value for colour in dict.fromkeys(wanted) for value in colour][: 3 * 256]
    image.putpalette(flat)
    return image
