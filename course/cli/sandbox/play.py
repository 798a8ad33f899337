"""``course sandbox play``: open a scene in a view, or run it without one and report the events."""

import contextlib
import importlib
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import msgspec

from course.cli.frame import here
from course.cli.frame.console import Console, current
from course.cli.frame.here import Here, cwd, named, target
from course.cli.frame.replies import Backup, Envelope, filled
from course.errors import CourseError, UsageError
from course.extras import require
from course.printable import counted
from course.progress.store import numbered
from course.sandbox.runs import running
from course.sandbox.runs.recording import Film, Recording, ffmpeg
from course.sandbox.runs.running import Run
from course.sandbox.scene.loading import (
    GUESS_LIKE,
    NO_GUESS,
    Chosen,
    Comparison,
    choose,
    guess_of,
    question,
    scene_ids,
    unwritten,
)
from course.sandbox.views.stage import Desk
from course.sandbox.world.accounts import Event, Receipt
from course.sandbox.world.engine import versions
from course.sandbox.world.world import Snapshot, World

# ---
# The replies of ``course sandbox ... --json``, as types.


class SandboxParameter(msgspec.Struct, frozen=True, kw_only=True):
    """Something ``--set`` can set; ``default`` is None where each body has its own."""

    name: str
    unit: str
    meaning: str
    low: float
    high: float
    default: float | None = None


class SandboxEntry(msgspec.Struct, frozen=True, kw_only=True):
    """A scene in a list; the student answers ``question`` before the run, ``after`` afterwards."""

    id: str
    title: str
    teaches: str
    question: str
    note: str
    after: str
    duration: float
    parameters: tuple[SandboxParameter, ...]


class SandboxList(Envelope, tag="course.sandbox-list/1", frozen=True, kw_only=True):
    scenes: tuple[SandboxEntry, ...]


class SandboxFile(msgspec.Struct, frozen=True, kw_only=True):
    """A file that was written, and the copy of what was there before."""

    kind: str
    path: str
    backup: Backup | None = None


class SandboxMomentum(msgspec.Struct, frozen=True, kw_only=True):
    """Along x and y in kg m/s, and angular about the origin in kg m²/s."""

    before: tuple[float, float, float]
    after: tuple[float, float, float]


class Sandbox(Envelope, tag="course.sandbox/1", frozen=True, kw_only=True):
    """One run of a scene.

    ``settings`` holds everything that was set or has a default; ``probes`` the scene's measurements, "nan"
    for events that did not happen; ``prediction`` is None where a scene asks for none. ``description`` is the
    run in sentences.
    """

    scene: str
    title: str
    duration: float
    steps: int
    settings: dict[str, float]
    receipt: Receipt
    momentum: SandboxMomentum
    probes: dict[str, float]
    prediction: Comparison | None
    events: tuple[Event, ...]
    dropped: int
    description: tuple[str, ...]
    after: str
    state_hash: str
    versions: dict[str, str]
    files: tuple[SandboxFile, ...] = ()


class SandboxVersion(msgspec.Struct, frozen=True, kw_only=True):
    """A part whose version differs from that of the recording."""

    name: str
    recorded: str
    here: str


class SandboxReplay(Envelope, tag="course.sandbox-replay/1", frozen=True, kw_only=True):
    """Whether a recording runs the same here; the steps are counted over the whole recording."""

    scene: str
    same: bool
    steps: int
    checked: int
    good_until: int
    first_difference: int | None
    t: float | None
    versions: tuple[SandboxVersion, ...]


class SandboxExport(Envelope, tag="course.sandbox-export/1", frozen=True, kw_only=True):
    """A scene as another engine's world; ``text`` is empty if it went to a file.

    ``beside`` is the file that a world for Gazebo needs in its folder to start with velocities.
    """

    scene: str
    format: str
    file: SandboxFile | None = None
    beside: SandboxFile | None = None
    text: str = ""


# ---
# The files that ``course sandbox`` reads and writes, and the settings on its command line.


def pairs(settings: Sequence[str]) -> dict[str, object]:
    """``KEY=VALUE`` as numbers.

    Raises:
        UsageError: one is not such a pair, or its value is not a number.
    """
    found: dict[str, object] = {}
    for pair in settings:
        key, sign, value = pair.partition("=")
        if not sign or not key:
            raise UsageError(f"--set {pair}: write KEY=VALUE.", help="For example --set gravity=1.62.")
        try:
            number = float(value)
        except ValueError:
            problem = f"--set {pair}: {value[:40]!r} is not a number."
            raise UsageError(problem, help="For example --set gravity=1.62.", code="bad_parameter") from None
        found[key.strip()] = int(number) if key == "seed" and number.is_integer() else number
    return found


def chosen(scene: str, settings: Sequence[str]) -> Chosen:
    """The scene of this name, or of this file in the current folder, with its settings."""
    if scene.endswith(".toml"):
        scene = str(named(scene))
    return choose(scene, pairs(settings))


def write(path: Path, data: bytes, kind: str) -> SandboxFile:
    """Write a file, keep a copy of an earlier one, and say so."""
    return filled(SandboxFile, here.write_told(path, data, why="sandbox"), kind=kind)


def table(run: Run) -> bytes:
    """The samples of a run as CSV: a line of names with units, then a row for each body and time."""
    rows = (
        (round(t, 9), name, *row)
        for t, names, state in run.samples
        for name, row in zip(names, state.tolist(), strict=True)
    )
    return here.as_csv(running.COLUMNS, rows)


#: Frames per simulated second of a film.
_FPS = 25.0
_LONGEST = 86_400.0
#: Between two samples of a table, in s, where nothing else is asked for.
_EVERY = 0.05


@dataclass(frozen=True)
class PlayOptions:
    """The command's options; see its help."""

    scene: str
    settings: list[str] | None
    web: bool
    headless: bool
    describe: bool
    guess: str | None
    duration: float | None
    csv: Path | None
    every: float | None
    gif: Path | None
    mp4: Path | None
    png: Path | None
    at: float | None
    record: Path | None
    port: int
    no_browser: bool

    @property
    def unseen(self) -> bool:
        """An option was given that shows no picture."""
        return self.headless or self.describe or any((self.csv, self.gif, self.mp4, self.png))


def _targets(options: PlayOptions) -> dict[str, Path]:
    """Where each kind of file goes, checked before anything runs."""
    endings = {"csv": "csv", "gif": "gif", "mp4": "mp4", "png": "png", "record": "jsonl"}
    given = {kind: path for kind in endings if (path := getattr(options, kind)) is not None}
    targets = {kind: target(path, f"--{kind}", (endings[kind],)) for kind, path in given.items()}
    if options.mp4 is not None:
        ffmpeg()
    return targets


def play(console: Console, options: PlayOptions) -> int:
    """Play a scene.

    Returns:
        the exit code.
    """
    _check(options)
    targets = _targets(options)
    picked = chosen(options.scene, tuple(options.settings or ()))
    end = picked.scene.duration if options.duration is None else options.duration
    if options.at is not None and options.at > end:
        problem = f"--at {options.at:g}: the run ends at {end:g} s."
        fix = f"Take a time up to {end:g}, or a longer --duration."
        raise UsageError(problem, help=fix, code="bad_parameter")
    given = None
    if options.guess is not None:  # with comma or point, with its unit or without
        asked = picked.scene.prediction
        if (given := guess_of(options.guess, asked.unit if asked is not None else "")) is None:
            said = f"--guess {options.guess} is not a number, or one too large."
            raise UsageError(said, help=GUESS_LIKE, code="bad_parameter")
    if lines := unwritten(picked.path):
        left = f"and {len(lines) - 1} more below are" if len(lines) > 1 else "is"
        console.note(f"{picked.path}:{lines[0]}: this line {left} still to be written.")
    if not options.web and (options.unseen or not console.interactive or not console.fancy):
        return _run_unseen(console, picked, options, targets, _guess(console, picked, given))
    browser = not options.no_browser
    recorded = open_view(picked, web=options.web, port=options.port, browser=browser, guess=given)
    if "record" in targets:
        write(targets["record"], recorded, "record")
    console.note(("After playing: ", "bold"), picked.scene.after)
    return 0


def _check(options: PlayOptions) -> None:
    if options.web and options.unseen:
        raise UsageError("--web opens a page; the other options run without one.", help="Choose one.")
    for option, value in (("--duration", options.duration), ("--every", options.every), ("--at", options.at)):
        low = 0.0 if option == "--at" else 1e-4
        if value is not None and not low <= value <= _LONGEST:
            raise UsageError(f"{option} must be from {low:g} to {_LONGEST:g} s.", code="bad_parameter")
    if options.at is not None and options.png is None:
        raise UsageError("--at says when the picture of --png is taken.", help="Add --png FILE.")
    if options.every is not None and options.csv is None:
        raise UsageError("--every says how far apart the samples of --csv are.", help="Add --csv FILE.")
    if options.port and not options.web:
        raise UsageError("--port says where the page of --web is.", help="Add --web.")


def _guess(console: Console, chosen: Chosen, given: float | None) -> float | None:
    """The student's guess: from the command line, or asked for in a terminal."""
    asked = chosen.scene.prediction
    if asked is None or given is not None:
        return given
    if not console.interactive or console.quiet:
        return None
    console.line((question(chosen), "bold"))
    while True:
        answer = console.ask(f"Your guess in {asked.unit} (Enter for none): ")
        if not answer:
            return None
        guess = guess_of(answer, asked.unit)
        if guess is not None:
            return guess
        console.line(NO_GUESS)


# -- seen ------------------------------------------------------------------------------------------------


def open_view(
    chosen: Chosen | None, *, web: bool, port: int, browser: bool, guess: float | None = None
) -> bytes:
    """Play a scene, or all of them, until the user leaves; the recording of what was played last.

    The view asks for the prediction and shows the comparison itself.
    """
    if web:
        require("web")
    play_in = _view("web" if web else "terminal")

    def say(text: str) -> None:
        current().line(text)
        current().flush()  # even into a file or a pipe: the page is served until somebody ends it

    more: dict[str, Any] = {"port": port, "open_browser": browser, "say": say} if web else {}
    return play_in(chosen, _desk(), guess=guess, **more)


def _view(name: str) -> Callable[..., bytes]:
    play_in: Callable[..., bytes] = importlib.import_module(f"course.sandbox.views.{name}.view").play
    return play_in


def _desk() -> Desk:
    """What a view may ask of this program: to keep things in the workspace, and files where it runs."""
    played: set[str] = set()
    with contextlib.suppress(CourseError):  # playing needs no workspace
        store = Here.load().workspace.store
        events = (*store.events("sandbox-guess"), *store.events("sandbox-played"))
        played = {event.subject for event in events}

    def opened(scene: str) -> None:
        if scene not in played and scene in scene_ids():
            played.add(scene)
            with contextlib.suppress(CourseError):
                Here.load().workspace.store.append("sandbox-played", scene, {})

    def save(name: str, data: bytes) -> str:
        path = next(path for path in numbered(cwd() / name) if not path.exists())
        return str(here.write(path, data, why="sandbox").path)

    return Desk(keep=_keep, save=save, played=set(played), opened=opened)


# -- unseen ----------------------------------------------------------------------------------------------


def _run_unseen(
    console: Console, chosen: Chosen, options: PlayOptions, targets: dict[str, Path], guess: float | None
) -> int:
    made: dict[str, Any] = {}
    film, pictures = Film(chosen.scene), targets.keys() & {"gif", "mp4", "png"}
    filming = bool(pictures - {"png"})
    recordings: list[Recording] = []
    watch = (lambda world: recordings.append(Recording(world))) if "record" in targets else None
    end = chosen.scene.duration if options.duration is None else options.duration
    at = math.inf if options.at is None else options.at

    def draw(world: World, snapshot: Snapshot) -> None:
        # The moment of --at lies between the film's frames.
        if filming and round(snapshot.t * _FPS, 6) >= len(film):
            film.take(world.parts, snapshot)
        # The picture is the last frame up to that moment.
        if snapshot.t <= at + 1e-9:
            made["picture"] = (world.parts, snapshot)

    with console.working(f"Running {chosen.scene.id}"):
        done = running.run(
            chosen,
            duration=options.duration,
            guess=guess,
            every=(options.every or _EVERY) if options.csv else 0.0,
            on_frame=draw if pictures else None,
            fps=_FPS if filming else 1.0,
            also_at=(min(at, end),) if "png" in targets else (),
            watch=watch,
        )
    if recordings:
        made["record"] = recordings[0].encode()
    if "csv" in targets:
        made["csv"] = table(done)
    if pictures:
        with console.working("Drawing"):
            made |= {kind: getattr(film, kind)(_FPS) for kind in ("mp4", "gif") if kind in targets}
            if "png" in targets:
                made["png"] = film.png(*made["picture"])
    account = (*running.account(done.receipt), *running.momentum(done))
    told = (*running.sentences(done.events), *account)
    _show(console, chosen, done, told if options.describe else account, options)
    files = tuple(write(targets[kind], made[kind], kind) for kind in targets)
    if guess is not None:
        _keep(chosen, done.comparison)
    scene = chosen.scene
    settings = {"step": scene.step, "iterations": float(scene.iterations), "seed": float(scene.seed)}
    return console.answer(
        filled(
            Sandbox,
            done,
            scene=scene.id,
            title=scene.title,
            settings={**settings, **chosen.parameters, **chosen.settings},
            momentum=SandboxMomentum(before=done.momentum_before, after=done.momentum_after),
            prediction=done.comparison,
            description=told,
            after=scene.after,
            versions=versions(),
            files=files,
        )
    )


def _show(console: Console, chosen: Chosen, done: Run, told: tuple[str, ...], options: PlayOptions) -> None:
    if not console.quiet:
        console.heading(chosen.scene.title, f"{done.duration:.4g} s in {counted(done.steps, 'step')}")
        if not options.describe:
            count = sum(event.kind == "contact" for event in done.events)
            console.line(f"{counted(count, 'contact')}; --describe tells what happened.")
        for sentence in told:
            console.line(sentence)
        for probe in chosen.scene.probe:
            console.line(f"{probe.name}: {_happened(done.probes[probe.name], probe.unit)}")
    if (comparison := done.comparison) is not None:
        if not console.quiet:
            console.line((comparison.question, "bold"))
            unit = "" if comparison.unit == "1" else comparison.unit
            rows = [("theory", comparison.theory), ("simulation", comparison.simulation)]
            if comparison.guess is not None:
                rows.insert(0, ("your guess", comparison.guess))
            for name, value in rows:
                console.item(name, _happened(value, unit), width=10)
        console.line((comparison.verdict, "bold"))
        console.note(comparison.why)
    console.note(("Think: ", "bold"), chosen.scene.after)


def _happened(value: float, unit: str) -> str:
    return "did not happen" if math.isnan(value) else f"{value:.6g} {unit}".rstrip()


def _keep(chosen: Chosen, comparison: Comparison | None) -> None:
    """Put a guess into the workspace's progress, if there is a workspace."""
    if comparison is None or comparison.guess is None or chosen.own:
        return
    try:
        store = Here.load().workspace.store
    except CourseError:
        return  # playing needs no workspace
    simulation = comparison.simulation if math.isfinite(comparison.simulation) else None
    data: dict[str, Any] = {"guess": comparison.guess, "theory": comparison.theory, "simulation": simulation}
    data |= {"right": bool(comparison.guess_right), "settings": {**chosen.parameters, **chosen.settings}}
    store.append("sandbox-guess", chosen.scene.id, data)
