"""The sandbox as a notebook, and the functions its cells call: a scene as a film, with events and energy."""

from __future__ import annotations

import asyncio
import base64
import os
from dataclasses import dataclass
from html import escape
from importlib.util import find_spec
from typing import Any

from course.catalog.load import Catalog
from course.notebooks.cells import code, document, escaped, markdown, opening
from course.sandbox.runs.running import Run, account, run, sentences
from course.sandbox.scene.model import Scene

#: Set in the environment of a kernel whose outputs are saved: a live view cannot be saved.
STILL = "COURSE_NOTEBOOK_STILL"

#: A film is for watching, not for measuring: enough frames to see a motion, few enough to save.
_FPS, _WIDTH, _LONGEST = 20.0, 420, 6.0
_MOST_TOLD = 12
_HEAD = """\
# Sandbox

Collisions to play with: take hold of a body with the pointer and throw it, or choose one with N and push it
with the arrows. Settings go in as words: `play("{first}", gravity=1.6, restitution=0.5)`. Where the package
anywidget is not installed, a cell shows a film instead and tells what happened; `film(...)` always does."""


def sandbox_notebook(catalog: Catalog) -> bytes:
    """The notebook file of the sandbox: every scene with its question and a cell that runs it."""
    from course.sandbox.scene.loading import scenes

    every = scenes()
    cells = [
        opening(_HEAD.format(first=every[0].id)),
        code("from course.notebooks.sandbox import play", role="sandbox-setup"),
    ]
    for scene in every:
        cells.append(markdown(f"## {escaped(scene.title)}\n\n{_words(scene.note)}{_question(scene)}"))
        cells.append(code(f'play("{scene.id}")', role="scene", task=scene.id))
        cells.append(markdown(f"*{_words(scene.after)}*"))
    return document(cells, kind="sandbox", id="sandbox", version=catalog.version)


def _words(text: str) -> str:
    return escaped(" ".join(text.split()))


def _question(scene: Scene) -> str:
    from course.sandbox.scene.loading import question, unchanged

    asked = question(unchanged(scene))
    return f"\n\n**Predict.** {_words(asked)}" if asked else ""


def alive() -> bool:
    """Whether a cell can show a live view: it runs in a kernel, with anywidget installed."""
    if os.environ.get(STILL) or find_spec("anywidget") is None:
        return False
    try:
        asyncio.get_running_loop()
    except RuntimeError:  # a script
        return False
    return True


def play(scene_id: str, **settings: float) -> Any:
    """A live scene; a film of it where this Jupyter cannot show one.

    Arguments and errors are those of ``film``.
    """
    if not alive():
        return film(scene_id, **settings)
    from course.notebooks.widgets import Sandbox

    return Sandbox(scene_id, **settings)


def film(scene_id: str, **settings: float) -> Film:
    """Run a scene to its end and keep it as a film.

    Args:
        scene_id: see ``course sandbox list``; or the path of a scene of your own.
        settings: the scene's parameters, and gravity, restitution, friction, step or iterations.

    Raises:
        NotFoundError: there is no such scene.
        UsageError: a setting is unknown or out of range.
    """
    from course.sandbox.runs.recording import Film as Frames
    from course.sandbox.scene.loading import choose

    chosen = choose(scene_id, settings)
    frames = Frames(chosen.scene, _WIDTH)
    length = min(chosen.scene.duration, _LONGEST)
    done = run(
        chosen,
        on_frame=lambda world, shown: None if shown.t > length else frames.take(world.parts, shown),
        fps=_FPS,
    )
    return Film(chosen.scene.title, frames.gif(_FPS), done)


@dataclass(frozen=True)
class Film:
    """A scene that was run, as Jupyter shows it.

    Attributes:
        data: the GIF.
        run: everything about the run, to compute with.
    """

    title: str
    data: bytes
    run: Run

    @property
    def story(self) -> list[str]:
        """The run in sentences, its energy last."""
        compared = self.run.comparison
        ending = [] if compared is None else [compared.verdict, compared.why]
        return [*sentences(self.run.events, _MOST_TOLD), *account(self.run.receipt), *ending]

    def __repr__(self) -> str:
        return "\n".join([self.title, *self.story])

    def _repr_html_(self) -> str:
        picture = base64.b64encode(self.data).decode()
        told = "".join(f"<li>{escape(line)}</li>" for line in self.story)
        return (
            f'<img alt="{escape(self.title)}, as it moves; in words below." '
            f'src="data:image/gif;base64,{picture}"><ul>{told}</ul>'
        )
