"""``course sandbox``: scenes to play with, to run without a view, to film, to replay and to export."""

import difflib
import math
import shlex
from pathlib import Path
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from course.cli.frame.console import Console, current
from course.cli.frame.here import named
from course.cli.frame.here import target as target_file
from course.cli.frame.options import argument, choice_of, option, scene_ids, scene_settings
from course.cli.frame.registry import COMMANDS, OPTIONS
from course.cli.frame.replies import filled
from course.cli.sandbox import play as playing
from course.errors import NotFoundError, UsageError
from course.printable import counted
from course.sandbox.exports.formats import START, mjcf, sdf, start_script
from course.sandbox.runs import recording
from course.sandbox.scene.loading import question, scenes, unchanged
from course.sandbox.scene.loading import scene_ids as known_scenes
from course.sandbox.scene.model import Scene
from course.sandbox.scene.rules import settings_of


class _Scenes(TyperGroup):
    """`course sandbox SCENE` plays it: no command is named like a scene."""

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        name = args[0]
        if self.get_command(ctx, name) is None and (name.isdecimal() or name in known_scenes()):
            args = ["play", *args]
        elif self.get_command(ctx, name) is None:
            # Say which scene was meant, unless a command is as close; either way it is no command, exit 2.
            close = difflib.get_close_matches(name, [*self.commands, *known_scenes()], n=1)
            if close and close[0] not in self.commands:
                problem = f"There is no scene {name!r}."
                fix = f"Did you mean: course sandbox play {close[0]}?"
                raise UsageError(problem, help=fix, code="scene_not_found")
        return super().resolve_command(ctx, args)


app = typer.Typer(cls=_Scenes, help=COMMANDS["sandbox"].summary, invoke_without_command=True, **OPTIONS)

_OWN = "ID.toml, a file of your own (while a scene plays, / and then mine writes one)"
_SCENE = argument("SCENE", f"A scene, or {_OWN}.", scene_ids)
_SET = option("--set KEY=VALUE", "Set a parameter; repeatable.", scene_settings)


@app.callback(epilog="Example: course sandbox play newtons-cradle")
def menu(
    ctx: typer.Context,
    web: Annotated[bool, option("--web", "In a browser, on this machine only.")] = False,
    port: Annotated[int, option("--port", "For --web; 0 takes a free one.")] = 0,
    no_browser: Annotated[bool, option("--no-browser", "For --web: only print the address.")] = False,
) -> int | None:
    """Play with collisions, and see where the energy goes.

    Without a command: all scenes to choose from, in a terminal or with --web; the list anywhere else.
    """
    if ctx.invoked_subcommand is not None:
        return None
    console = current()
    if web or (console.interactive and console.fancy):
        playing.open_view(None, web=web, port=port, browser=not no_browser)
    else:
        _list(console, None)
    return 0


@app.command("list", epilog="Example: course sandbox list newtons-cradle")
def list_scenes(scene: Annotated[str | None, _SCENE] = None) -> int:
    """List the scenes, or one of them with all its parameters.

    Each asks for a number: guess it before you run the scene, then see.
    """
    _list(current(), scene)
    return 0


@app.command(epilog="Example: course sandbox play restitution-row --guess 3.5 --describe")
def play(
    scene: Annotated[str, _SCENE],
    settings: Annotated[list[str] | None, _SET] = None,
    web: Annotated[bool, option("--web", "In a browser, on this machine only.")] = False,
    headless: Annotated[bool, option("--headless", "Show no picture; run as fast as possible.")] = False,
    describe: Annotated[bool, option("--describe", "Describe the run in sentences.")] = False,
    guess: Annotated[str | None, option("--guess NUMBER", "Your answer to the scene's question.")] = None,
    duration: Annotated[
        float | None, option("--duration S", "Simulated seconds; the scene's own if left out.")
    ] = None,
    csv: Annotated[
        Path | None, option("--csv FILE", "Write positions and velocities over time, as a table.")
    ] = None,
    every: Annotated[
        float | None, option("--every S", "Seconds between the samples of --csv; 0.05 if left out.")
    ] = None,
    gif: Annotated[Path | None, option("--gif FILE", "Write a film.")] = None,
    mp4: Annotated[Path | None, option("--mp4 FILE", "Write a film; needs ffmpeg.")] = None,
    png: Annotated[Path | None, option("--png FILE", "Write one picture.")] = None,
    at: Annotated[float | None, option("--at S", "When the picture is taken; else at the end.")] = None,
    record: Annotated[Path | None, option("--record FILE", "Write a recording to replay.")] = None,
    port: Annotated[int, option("--port", "For --web; 0 takes a free one.")] = 0,
    no_browser: Annotated[bool, option("--no-browser", "For --web: only print the address.")] = False,
) -> int:
    """Play a scene, or run it unseen.

    In a terminal the scene opens for you to play with. With --headless, --describe, --json, a file to write,
    or outside a terminal, it runs to its end and shows theory, guess and simulation side by side.
    """
    return playing.play(current(), playing.PlayOptions(**locals()))  # a field for each option


@app.command(epilog="Example: course sandbox replay run.jsonl")
def replay(file: Annotated[Path, argument("FILE", "A recording.")]) -> int:
    """Run a recording again, and say where it first differs.

    Exit code 1 if it does.
    """
    console, recorded = current(), recording.read(named(file))
    with console.working("Replaying"):
        difference = recording.replay(recorded)
    versions = tuple(
        playing.SandboxVersion(name=name, recorded=then, here=here)
        for name, (then, here) in difference.versions.items()
    )
    for one in versions:
        console.line(f"Recorded with {one.name} {one.recorded}; here it is {one.here}.")
    if difference.same:
        states = counted(difference.checked, "state")
        console.line(f"The same, bit by bit: {counted(recorded.ticks, 'step')}, {states} compared.")
    else:
        at = f"step {difference.tick} (t = {difference.t:.3f} s)"
        console.line(f"It differs at {at}; up to step {difference.good_until} it was the same.")
        if not versions:
            console.note("All versions are the same: the file was changed, or this is a fault of the course.")
    return console.answer(
        filled(
            playing.SandboxReplay,
            difference,
            exit_code=0 if difference.same else 1,
            scene=recorded.head.scene.id,
            steps=recorded.ticks,
            first_difference=difference.tick,
            versions=versions,
        )
    )


@app.command(epilog="Example: course sandbox export unequal-masses --format mjcf -o world.xml")
def export(
    scene: Annotated[str, _SCENE],
    format_: Annotated[
        str, option("--format sdf|mjcf", "sdf (Gazebo) or mjcf (MuJoCo).", choice_of("sdf", "mjcf"))
    ],
    output: Annotated[
        Path | None, option("--output -o FILE", "File to write; the screen if left out.")
    ] = None,
    settings: Annotated[list[str] | None, _SET] = None,
) -> int:
    """Write a scene as a world for Gazebo or MuJoCo."""
    writers = {"sdf": sdf, "mjcf": mjcf}
    if format_ not in writers:
        raise UsageError(f"There is no format {format_[:20]!r}.", help="Formats: sdf, mjcf.")
    console = current()
    endings = ("sdf", "world", "xml") if format_ == "sdf" else ("xml",)
    target = target_file(output, "-o", endings) if output else None
    chosen = playing.chosen(scene, settings or ())
    data = writers[format_](chosen)
    written = beside = None
    start = start_script(data) if format_ == "sdf" else None
    if target is not None:
        written = playing.write(target, data, format_)
    elif not console.json:
        console.raw(data.decode())
    if start is not None and target is None:
        console.warn(f"Its velocities at the start need a file beside it: with -o FILE, {START} comes along.")
    elif start is not None and target is not None:
        beside = playing.write(target.with_name(START), start, "python")
        folder = shlex.quote(str(target.parent))
        console.note(f"Run it: GZ_SIM_SYSTEM_PLUGIN_PATH={folder} gz sim {shlex.quote(str(target))}")
    text = "" if written else data.decode()
    return console.answer(
        playing.SandboxExport(scene=chosen.scene.id, format=format_, file=written, beside=beside, text=text)
    )


def _list(console: Console, name: str | None) -> None:
    one = None if name is None else playing.chosen(name, ())
    found = scenes() if one is None else (one.scene,)
    if not found:
        raise NotFoundError("There are no scenes.", help="Install the course again.", code="no_scenes")
    for place, scene in enumerate(found if one is None else (), 1):
        console.item(f"{place:2d}", f"{scene.id}: {scene.teaches}", width=3)
    if one is not None:
        entry = _entry(one.scene)
        console.heading(entry.id, entry.title)
        console.line(entry.note)
        if entry.question:
            console.item("guess", entry.question, width=5)
        for parameter in entry.parameters:
            default = "each body's own" if parameter.default is None else f"{parameter.default:g}"
            unit = "" if parameter.unit == "1" else f" {parameter.unit}"
            span = f"{parameter.low:g} to {parameter.high:g}"
            console.item("set", f"{parameter.name}={default}{unit} ({span}): {parameter.meaning}", width=5)
        console.item("after", entry.after, width=5)
        console.item("file", str(one.path), width=5)
    console.note((f"Next: course sandbox play {name or found[0].id}", "bold"))
    console.emit(playing.SandboxList(scenes=tuple(_entry(scene) for scene in found)))


def _entry(scene: Scene) -> playing.SandboxEntry:
    wheels = next((body.wheels for body in scene.body if body.wheels), None)
    own = {
        "gravity": math.hypot(*scene.gravity),
        "step": scene.step,
        "iterations": float(scene.iterations),
        "walls": 0.0,
        "seed": float(scene.seed),
        "left": wheels.left if wheels else None,
        "right": wheels.right if wheels else None,
    }
    parameters = [filled(playing.SandboxParameter, one) for one in scene.parameter]
    parameters += [
        filled(playing.SandboxParameter, one, default=own.get(one.name)) for one in settings_of(scene)
    ]
    asked, note = question(unchanged(scene)), " ".join(scene.note.split())
    return filled(playing.SandboxEntry, scene, question=asked, note=note, parameters=tuple(parameters))
