"""``course sandbox play``: open a scene in a view, or run it without one and report the events."""

from __future__ import annotations

import importlib
import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from course.cli.frame.here import Here
from course.cli.sandbox import files as sandbox_files
from course.cli.sandbox.replies import Sandbox, SandboxMomentum
from course.errors import CourseError, MissingCapabilityError, UsageError
from course.extras import require
from course.sandbox.runs.film import Film, ffmpeg
from course.sandbox.scene.loading import question
from course.sandbox.scene.predicting import NO_GUESS, guess_of

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from course.cli.frame.terminal.console import Console
    from course.cli.sandbox.replies import SandboxFile
    from course.sandbox.runs.recording import Recording
    from course.sandbox.runs.running import Run
    from course.sandbox.scene.loading import Chosen
    from course.sandbox.scene.predicting import Comparison
    from course.sandbox.world.world import Snapshot, World

__all__ = ["PlayOptions", "play"]

#: Frames per simulated second of a film.
_FPS = 25.0
_LONGEST = 86_400.0


@dataclass(frozen=True)
class PlayOptions:
    """The command's options; see its help."""

    scene: str
    settings: list[str] | None
    web: bool
    headless: bool
    describe: bool
    guess: float | None
    duration: float | None
    csv: Path | None
    every: float
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


@dataclass
class _Targets:
    """Where files go, checked before anything runs."""

    paths: dict[str, Path] = field(default_factory=dict)

    @classmethod
    def of(cls, options: PlayOptions) -> _Targets:
        paths = {}
        for kind, path, endings in (
            ("csv", options.csv, ("csv",)),
            ("gif", options.gif, ("gif",)),
            ("mp4", options.mp4, ("mp4",)),
            ("png", options.png, ("png",)),
            ("record", options.record, ("jsonl",)),
        ):
            if path is not None:
                paths[kind] = sandbox_files.target(path, f"--{kind}", endings)
        if options.mp4 is not None:
            ffmpeg()
        return cls(paths)


def play(console: Console, options: PlayOptions) -> int:
    """Play a scene.

    Returns:
        the exit code.
    """
    _check(options)
    targets = _Targets.of(options)
    chosen = sandbox_files.chosen(options.scene, tuple(options.settings or ()))
    if options.web:
        require("web")
    seen = options.web or (not options.unseen and console.interactive and console.fancy)
    if seen:
        return _play_seen(console, chosen, options, targets)
    return _run_unseen(console, chosen, options, targets, _guess(console, chosen, options))


def _check(options: PlayOptions) -> None:
    if options.web and options.unseen:
        raise UsageError("--web opens a page; the other options run without one.", help="Choose one.")
    for option, value in (("--duration", options.duration), ("--every", options.every), ("--at", options.at)):
        low = 0.0 if option == "--at" else 1e-4
        if value is not None and not low <= value <= _LONGEST:
            raise UsageError(f"{option} must be from {low:g} to {_LONGEST:g} s.", code="bad_parameter")
    if options.guess is not None and not math.isfinite(options.guess):
        raise UsageError("--guess must be a finite number.", code="bad_parameter")
    if options.at is not None and options.png is None:
        raise UsageError("--at says when the picture of --png is taken.", help="Add --png FILE.")


def _guess(console: Console, chosen: Chosen, options: PlayOptions) -> float | None:
    """The student's guess: from the command line, or asked for in a terminal."""
    asked = chosen.scene.prediction
    if asked is None or options.guess is not None:
        return options.guess
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


def _play_seen(console: Console, chosen: Chosen, options: PlayOptions, targets: _Targets) -> int:
    """Open a view; it asks for the prediction and shows the comparison itself."""
    from course.sandbox.runs.recording import Recording
    from course.sandbox.world.world import World

    world = World(chosen.scene, chosen.settings)
    recording = Recording(world) if "record" in targets.paths else None
    view = _view("web" if options.web else "terminal")
    more: dict[str, Any] = {"chosen": chosen, "guess": options.guess, "keep": lambda c: _keep(chosen, c)}
    if options.web:
        more |= {"port": options.port, "open_browser": not options.no_browser, "say": _saying(console)}
    try:
        view(world, chosen.scene, **more)
    except KeyboardInterrupt:
        pass  # the usual way to leave
    finally:
        if recording is not None:
            sandbox_files.write(console, targets.paths["record"], recording.encode(), "record")
    console.note(("After playing: ", "bold"), chosen.scene.after)
    return 0


def _saying(console: Console) -> Callable[[str], None]:
    """Say a line at once, even into a file or a pipe: the page is served until somebody ends it."""

    def say(text: str) -> None:
        console.line(text)
        console.flush()

    return say


def _view(name: str) -> Callable[..., None]:
    """A view's ``play``."""
    try:
        module = importlib.import_module(f"course.sandbox.views.{name}.view")
    except ModuleNotFoundError as error:
        raise MissingCapabilityError(
            f"This installation has no {name} view ({error.name} is missing).",
            help="Run the scene with --headless, --describe or --gif FILE.",
            code="no_view",
        ) from error
    play_in: Callable[..., None] = module.play
    return play_in


# -- unseen ----------------------------------------------------------------------------------------------


def _run_unseen(
    console: Console, chosen: Chosen, options: PlayOptions, targets: _Targets, guess: float | None
) -> int:
    from course.sandbox.runs.recording import Recording
    from course.sandbox.runs.running import run

    made: dict[str, Any] = {}
    film = Film(chosen.scene) if {"gif", "mp4", "png"} & targets.paths.keys() else None
    recordings: list[Recording] = []
    watch = (lambda world: recordings.append(Recording(world))) if "record" in targets.paths else None
    filming = bool({"gif", "mp4"} & targets.paths.keys())
    with console.working(f"Running {chosen.scene.id}"):
        done = run(
            chosen,
            duration=options.duration,
            guess=guess,
            every=options.every if options.csv else 0.0,
            on_frame=None if film is None else _taker(film, options, made, filming=filming),
            fps=_FPS if filming else 1.0,
            also_at=_picture_times(chosen, options),
            watch=watch,
        )
    if recordings:
        made["record"] = recordings[0].encode()
    if "csv" in targets.paths:
        made["csv"] = sandbox_files.table(done)
    if film is not None:
        with console.working("Drawing"):
            made |= {kind: getattr(film, kind)(_FPS) for kind in ("gif", "mp4") if kind in targets.paths}
            if "png" in targets.paths:
                made["png"] = film.png(*made["picture"])
    told = _sentences(done)
    _show(console, chosen, done, told, options)
    files = tuple(
        sandbox_files.write(console, targets.paths[kind], made[kind], kind) for kind in targets.paths
    )
    if guess is not None:
        _keep(chosen, done.comparison)
    _emit(console, chosen, done, told, files)
    return 0


def _picture_times(chosen: Chosen, options: PlayOptions) -> tuple[float, ...]:
    """The time of the one picture: the end by default."""
    if options.png is None:
        return ()
    end = chosen.scene.duration if options.duration is None else options.duration
    return (end if options.at is None else min(options.at, end),)


def _taker(
    film: Film, options: PlayOptions, made: dict[str, Any], *, filming: bool
) -> Callable[[World, Snapshot], None]:
    """Takes every frame of a film, and the one picture."""

    def take(world: World, snapshot: Snapshot) -> None:
        # The moment of --at lies between the film's frames.
        if filming and round(snapshot.t * _FPS, 6) >= len(film):
            film.take(world.parts, snapshot)
        # The picture is the last frame up to that moment.
        if options.png is not None and (options.at is None or snapshot.t <= options.at + 1e-9):
            made["picture"] = (world.parts, snapshot)

    return take


def _sentences(done: Run) -> tuple[str, ...]:
    from course.sandbox.runs import describe

    return (*describe.sentences(done.events), *describe.account(done.receipt), *describe.momentum(done))


def _show(console: Console, chosen: Chosen, done: Run, told: tuple[str, ...], options: PlayOptions) -> None:
    if not console.quiet:
        console.heading(chosen.scene.title, f"{done.duration:.4g} s in {done.steps} steps")
        if not options.describe:
            count = sum(event.kind == "contact" for event in done.events)
            console.line(f"{count} contact{'' if count == 1 else 's'}; --describe tells what happened.")
        for sentence in told if options.describe else told[-_account_lines(done) :]:
            console.line(sentence)
        for probe in chosen.scene.probe:
            value = done.probes[probe.name]
            unit = f" {probe.unit}" if probe.unit else ""
            console.line(f"{probe.name}: {'did not happen' if math.isnan(value) else f'{value:.6g}{unit}'}")
    _show_comparison(console, done.comparison)
    console.note(("Think: ", "bold"), chosen.scene.after)


def _account_lines(done: Run) -> int:
    from course.sandbox.runs import describe

    return len(describe.account(done.receipt)) + len(describe.momentum(done))


def _show_comparison(console: Console, comparison: Comparison | None) -> None:
    if comparison is None:
        return
    if not console.quiet:
        console.line((comparison.question, "bold"))
        rows = [("theory", comparison.theory), ("simulation", comparison.simulation)]
        if comparison.guess is not None:
            rows.insert(0, ("your guess", comparison.guess))
        unit = "" if comparison.unit == "1" else f" {comparison.unit}"
        for name, value in rows:
            shown = "did not happen" if math.isnan(value) else f"{value:.6g}{unit}"
            console.item(name, shown, width=10)
    console.line((comparison.verdict, "bold"))
    console.note(comparison.why)


def _keep(chosen: Chosen, comparison: Comparison | None) -> None:
    """Put a guess into the workspace's progress, if there is a workspace."""
    if comparison is None or comparison.guess is None or chosen.own:
        return

    try:
        store = Here.load().workspace.store
    except CourseError:
        return  # playing needs no workspace
    store.append(
        "sandbox-guess",
        chosen.scene.id,
        {
            "guess": comparison.guess,
            "theory": comparison.theory,
            "simulation": comparison.simulation if math.isfinite(comparison.simulation) else None,
            "right": bool(comparison.guess_right),
            "settings": {**chosen.parameters, **chosen.settings},
        },
    )


def _emit(
    console: Console, chosen: Chosen, done: Run, told: tuple[str, ...], files: tuple[SandboxFile, ...]
) -> None:
    from course.sandbox.world.engine import versions

    if not console.json:
        return
    scene = chosen.scene
    settings = {"step": scene.step, "iterations": float(scene.iterations), "seed": float(scene.seed)}
    console.emit(
        Sandbox(
            scene=scene.id,
            title=scene.title,
            duration=done.duration,
            steps=done.steps,
            settings={**settings, **chosen.parameters, **chosen.settings},
            receipt=done.receipt,
            momentum=SandboxMomentum(before=done.momentum_before, after=done.momentum_after),
            probes=done.probes,
            prediction=done.comparison,
            events=done.events,
            dropped=done.dropped,
            description=told,
            after=scene.after,
            state_hash=done.state_hash,
            versions=versions(),
            files=files,
        )
    )
