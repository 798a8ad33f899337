"""``course sandbox play``: open a scene in a view, or run it unseen and tell what happened."""

from __future__ import annotations

import importlib
import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from course.cli import sandbox_files
from course.errors import CourseError, MissingCapabilityError, UsageError

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from course.cli.console import Console
    from course.cli.sandbox_schemas import SandboxFile
    from course.sandbox.film import Film
    from course.sandbox.loading import Chosen
    from course.sandbox.predicting import Comparison
    from course.sandbox.recording import Recording
    from course.sandbox.running import Run
    from course.sandbox.world import Snapshot, World

__all__ = ["Wish", "play"]

#: Frames per simulated second of a film.
_FPS = 25.0
_LONGEST = 86_400.0


@dataclass(frozen=True)
class Wish:
    """What was asked for on the command line; see the command's options."""

    scene: str
    settings: tuple[str, ...] = ()
    web: bool = False
    headless: bool = False
    describe: bool = False
    guess: float | None = None
    duration: float | None = None
    csv: Path | None = None
    every: float = 0.05
    gif: Path | None = None
    mp4: Path | None = None
    png: Path | None = None
    at: float | None = None
    record: Path | None = None
    port: int = 0
    open_browser: bool = True

    @property
    def unseen(self) -> bool:
        """Something was asked for that needs no eyes on it."""
        return self.headless or self.describe or any((self.csv, self.gif, self.mp4, self.png))


@dataclass
class _Targets:
    """Where files go, checked before anything runs."""

    paths: dict[str, Path] = field(default_factory=dict)

    @classmethod
    def of(cls, wish: Wish) -> _Targets:
        from course.sandbox.film import ffmpeg

        paths = {}
        for kind, path, endings in (
            ("csv", wish.csv, ("csv",)),
            ("gif", wish.gif, ("gif",)),
            ("mp4", wish.mp4, ("mp4",)),
            ("png", wish.png, ("png",)),
            ("record", wish.record, ("jsonl",)),
        ):
            if path is not None:
                paths[kind] = sandbox_files.target(path, f"--{kind}", endings)
        if wish.mp4 is not None:
            ffmpeg()
        return cls(paths)


def play(console: Console, wish: Wish) -> int:
    """Play a scene.

    Returns:
        the exit code.
    """
    _check(wish)
    targets = _Targets.of(wish)
    chosen = sandbox_files.chosen(wish.scene, wish.settings)
    if wish.web:
        from course.sandbox.views import web

        web.need()
    seen = wish.web or (not wish.unseen and console.interactive and console.fancy)
    if seen:
        return _play_seen(console, chosen, wish, targets)
    return _run_unseen(console, chosen, wish, targets, _guess(console, chosen, wish))


def _check(wish: Wish) -> None:
    if wish.web and wish.unseen:
        raise UsageError(
            "--web is for eyes, and what else was asked for runs unseen.", help="Ask for one at a time."
        )
    for option, value in (("--duration", wish.duration), ("--every", wish.every), ("--at", wish.at)):
        low = 0.0 if option == "--at" else 1e-4
        if value is not None and not low <= value <= _LONGEST:
            raise UsageError(f"{option} must be from {low:g} to {_LONGEST:g} s.", code="bad_parameter")
    if wish.guess is not None and not math.isfinite(wish.guess):
        raise UsageError("--guess must be a finite number.", code="bad_parameter")
    if wish.at is not None and wish.png is None:
        raise UsageError("--at says when the picture of --png is taken.", help="Add --png FILE.")


def _guess(console: Console, chosen: Chosen, wish: Wish) -> float | None:
    """The student's number: given, or asked for where somebody is there to answer."""
    asked = chosen.scene.prediction
    if asked is None or wish.guess is not None:
        return wish.guess
    if not console.interactive or console.quiet:
        return None
    from course.sandbox.loading import question

    console.line((question(chosen), "bold"))
    while True:
        answer = console.ask(f"Your guess in {asked.unit} (Enter for none): ")
        if not answer:
            return None
        try:
            guess = float(answer.replace(",", "."))
        except ValueError:
            guess = math.nan
        if math.isfinite(guess):
            return guess
        console.line("That is no number.")


# -- seen ------------------------------------------------------------------------------------------------


def _play_seen(console: Console, chosen: Chosen, wish: Wish, targets: _Targets) -> int:
    """Open a view; it asks for the prediction and shows the comparison itself."""
    from course.sandbox.recording import Recording
    from course.sandbox.world import World

    world = World(chosen.scene, chosen.settings)
    recording = Recording(world) if "record" in targets.paths else None
    view = _view("web" if wish.web else "terminal")
    options: dict[str, Any] = {"chosen": chosen, "guess": wish.guess, "keep": lambda c: _keep(chosen, c)}
    if wish.web:
        options |= {"port": wish.port, "open_browser": wish.open_browser, "say": console.line}
    try:
        view(world, chosen.scene, **options)
    except KeyboardInterrupt:
        pass  # how one leaves
    finally:
        if recording is not None:
            sandbox_files.write(console, targets.paths["record"], recording.encode(), "record")
    console.note(("After playing: ", "bold"), chosen.scene.after)
    return 0


def _view(name: str) -> Callable[..., None]:
    """A view's ``play``."""
    try:
        module = importlib.import_module(f"course.sandbox.views.{name}")
    except ModuleNotFoundError as error:
        raise MissingCapabilityError(
            f"This installation has no {name} view ({error.name} is missing).",
            help="Run the scene with --headless, --describe or --gif FILE.",
            code="no_view",
        ) from error
    play_in: Callable[..., None] = module.play
    return play_in


# -- unseen ----------------------------------------------------------------------------------------------


def _run_unseen(console: Console, chosen: Chosen, wish: Wish, targets: _Targets, guess: float | None) -> int:
    from course.sandbox.film import Film
    from course.sandbox.recording import Recording
    from course.sandbox.running import run

    made: dict[str, Any] = {}
    film = Film(chosen.scene) if {"gif", "mp4", "png"} & targets.paths.keys() else None
    recordings: list[Recording] = []
    watch = (lambda world: recordings.append(Recording(world))) if "record" in targets.paths else None
    filming = bool({"gif", "mp4"} & targets.paths.keys())
    with console.working(f"Running {chosen.scene.id}"):
        done = run(
            chosen,
            duration=wish.duration,
            guess=guess,
            every=wish.every if wish.csv else 0.0,
            on_frame=None if film is None else _taker(film, wish, made, filming=filming),
            fps=_FPS if filming else 1.0,
            also_at=_picture_times(chosen, wish),
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
    _show(console, chosen, done, told, wish)
    files = tuple(
        sandbox_files.write(console, targets.paths[kind], made[kind], kind) for kind in targets.paths
    )
    if guess is not None:
        _keep(chosen, done.comparison)
    _emit(console, chosen, done, told, files)
    return 0


def _picture_times(chosen: Chosen, wish: Wish) -> tuple[float, ...]:
    """When the one picture is taken: at the end unless said otherwise."""
    if wish.png is None:
        return ()
    end = chosen.scene.duration if wish.duration is None else wish.duration
    return (end if wish.at is None else min(wish.at, end),)


def _taker(
    film: Film, wish: Wish, made: dict[str, Any], *, filming: bool
) -> Callable[[World, Snapshot], None]:
    """Takes every frame of a film, and the one picture."""

    def take(world: World, snapshot: Snapshot) -> None:
        # A moment asked for with --at lies between the film's frames and is none of them.
        if filming and round(snapshot.t * _FPS, 6) >= len(film):
            film.take(world.parts, snapshot)
        # The picture is the last frame that is not later than asked for.
        if wish.png is not None and (wish.at is None or snapshot.t <= wish.at + 1e-9):
            made["picture"] = (world.parts, snapshot)

    return take


def _sentences(done: Run) -> tuple[str, ...]:
    from course.sandbox import describe

    return (*describe.sentences(done.events), *describe.account(done.receipt), *describe.momentum(done))


def _show(console: Console, chosen: Chosen, done: Run, told: tuple[str, ...], wish: Wish) -> None:
    if not console.quiet:
        console.heading(chosen.scene.title, f"{done.duration:.4g} s in {done.steps} steps")
        if not wish.describe:
            count = sum(event.kind == "contact" for event in done.events)
            console.line(f"{count} contact{'' if count == 1 else 's'}; --describe tells what happened.")
        for sentence in told if wish.describe else told[-_account_lines(done) :]:
            console.line(sentence)
        for probe in chosen.scene.probe:
            value = done.probes[probe.name]
            unit = f" {probe.unit}" if probe.unit else ""
            console.line(f"{probe.name}: {'did not happen' if math.isnan(value) else f'{value:.6g}{unit}'}")
    _show_comparison(console, done.comparison)
    console.note(("Think: ", "bold"), chosen.scene.after)


def _account_lines(done: Run) -> int:
    from course.sandbox import describe

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
    from course.cli.here import Here

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
    from course.cli.sandbox_schemas import Sandbox, SandboxMomentum
    from course.sandbox.engine import versions

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
