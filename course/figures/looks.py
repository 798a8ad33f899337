"""What is wrong with a figure: it cannot be drawn, looks other than it did, or cannot be read.

How each looked when somebody last looked at it is kept, without its letters, whose shapes are FreeType's
business; what is written in it is kept as text.
"""

import inspect
import traceback
from collections.abc import Iterator
from importlib import import_module
from io import BytesIO
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.text import Text
from PIL import Image, ImageFilter

from course.errors import ContentError
from course.figures.registry import FIGURES, build
from course.figures.style import WIDTH_IN, house_style

_DPI = 50
#: Largest grey difference, of 255, anywhere in the picture after a small blur. Without letters matplotlib 3.9
#: and 3.11 draw the very same pixels; one method drawn as its neighbour differs by 16 and more.
TOLERANCE = 8.0
#: A title of so few words names a figure, and does not say what it shows.
_LEAST_WORDS = 6


def faults(figure_id: str, kept: Path) -> Iterator[ContentError]:
    """Everything wrong with a figure, each with the place to look at.

    Args:
        kept: the folder with the pictures and texts to compare with.
    """
    module, function = FIGURES[figure_id]
    file = Path(__file__).with_name(f"{module}.py")
    try:
        builder = inspect.unwrap(getattr(import_module(f"course.figures.{module}"), function))
        file, line = Path(builder.__code__.co_filename), builder.__code__.co_firstlineno
        figure = build(figure_id)
        with house_style():
            figure.draw_without_rendering()  # it lays everything out
    except Exception as error:  # noqa: BLE001 - whatever a builder raises
        frames = traceback.extract_tb(error.__traceback__)
        own = [frame for frame in frames if Path(frame.filename).parent == Path(__file__).parent]
        own = [frame for frame in own if Path(frame.filename).name not in {"looks.py", "registry.py"}]
        at = own[-1] if own else None
        yield ContentError(
            Path(at.filename) if at else file,
            at.lineno if at else None,
            f"figure {figure_id} cannot be drawn: {type(error).__name__}: {error}.",
            help="Correct the builder, or its entry in course/figures/registry.py.",
        )
        return
    for problem, fix in (*_unreadable(figure), *_changed(figure_id, figure, kept)):
        yield ContentError(file, line, f"figure {figure_id} {problem}", help=fix)


def picture_and_words(figure_id: str) -> tuple[bytes, bytes]:
    """A figure's picture without letters, as a PNG file, and what is written in it, one text a line."""
    figure = build(figure_id)
    return _without_letters(figure), _letters(figure).encode()


def _unreadable(figure: Figure) -> Iterator[tuple[str, str]]:
    if len(figure.get_suptitle().split()) < _LEAST_WORDS:
        yield "has no title that says what it shows.", "Give it a finding: figure.suptitle(...)."
    if figure.get_figwidth() != WIDTH_IN:
        yield (
            f"is {figure.get_figwidth():g} inches wide, and a page has {WIDTH_IN:g}.",
            "Make it with course.figures.style, which knows the width.",
        )
    labels = [label for axes in figure.axes for label in (axes.get_xlabel(), axes.get_ylabel()) if label]
    for label in dict.fromkeys(labels):
        if "(" not in label:
            yield (
                f"has the label {label!r} without a unit.",
                'Write it in brackets: "time (s)", or "(no unit)".',
            )
    if not any(axes.get_xlabel() for axes in figure.axes):
        yield "has no label below its axes.", 'Say what they show: axes.set_xlabel("time (s)").'
    # Of the words alone: an annotation's own extent includes its line.
    texts = [text for axes in figure.axes for text in (*axes.texts, axes.title) if text.get_text()]
    boxes = [(text.get_text(), Text.get_window_extent(text)) for text in texts]
    page = figure.bbox
    for index, (words, box) in enumerate(boxes):
        if not (page.x0 <= box.x0 and box.x1 <= page.x1 and box.y1 <= page.y1):
            yield f"has the text {words!r} outside of the page.", "Move it, or make it shorter."
        for other, behind in boxes[index + 1 :]:
            if box.overlaps(behind):
                yield f"has {words!r} written over {other!r}.", "Move one of the two."


def _changed(figure_id: str, figure: Figure, kept: Path) -> Iterator[tuple[str, str]]:
    again = f"Look at it; if it is right: course author pictures {figure_id}"
    picture, text = kept / f"{figure_id}.png", kept / f"{figure_id}.txt"
    if not picture.is_file() or not text.is_file():
        yield "has no picture to be compared with.", again
        return
    if text.read_text("utf-8") != _letters(figure):
        yield "says other words than when somebody last read it.", again
    looked, looks = (_grey(one) for one in (picture, BytesIO(_without_letters(figure))))
    if looked.shape != looks.shape or np.max(np.abs(looks - looked)) >= TOLERANCE:
        yield "looks other than when somebody last looked at it.", again


def _without_letters(figure: Figure) -> bytes:
    out = BytesIO()
    with house_style():
        letters = [text for text in figure.findobj(Text) if text.get_visible()]
        for text in letters:
            text.set_visible(False)
        figure.savefig(out, format="png", dpi=_DPI, metadata={"Software": None})
        for text in letters:
            text.set_visible(True)
    return out.getvalue()


def _grey(picture: BytesIO | Path) -> np.ndarray:
    """In grey and blurred a little."""
    image = Image.open(picture).convert("L").filter(ImageFilter.BoxBlur(2))
    return np.asarray(image, dtype=float)


def _letters(figure: Figure) -> str:
    """Everything written in a figure but the numbers at the axes, one text a line."""
    texts = [figure.get_suptitle()]
    for axes in figure.axes:
        texts += [axes.get_title(loc="left"), axes.get_xlabel(), axes.get_ylabel()]
        texts += [text.get_text().replace("\n", " ") for text in axes.texts]
    return "\n".join(filter(None, texts)) + "\n"
