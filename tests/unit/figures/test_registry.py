"""The figures: each can be drawn, looks as it did, says what it shows and can be told apart by anyone."""

from __future__ import annotations

import functools
import io
import os
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.transforms import Bbox
from PIL import Image, ImageFilter

from course.errors import NotFoundError, UsageError
from course.figures import registry
from course.figures.style import METHODS, WIDTH_IN, house_style

GOLDEN = Path(__file__).parents[2] / "fixtures" / "golden"
GOLDEN_DPI = 50
#: Largest grey difference, of 255, anywhere in the picture after a small blur. Without letters, whose shapes
#: are FreeType's business, matplotlib 3.9 and 3.11 draw the very same pixels; one method drawn as its
#: neighbour differs by 16 and more.
TOLERANCE = 8.0


class Drawn(NamedTuple):
    """A figure that was drawn once, and where its words lie on its page."""

    figure: Figure
    words: list[Bbox]


def drawn(figure_id: str) -> Drawn:
    figure = registry.build(figure_id)
    with house_style():
        figure.draw_without_rendering()  # it lays everything out
    words = [
        Text.get_window_extent(text)  # of the words alone: an annotation's own extent includes its line
        for axes in figure.axes
        for text in [*axes.texts, axes.title]
        if text.get_text()
    ]
    return Drawn(figure, words)


#: Each drawn once for all tests that look at it.
once = functools.cache(drawn)


def built(figure_id: str) -> Figure:
    return once(figure_id).figure


def without_letters(figure: Figure, figure_id: str) -> np.ndarray:
    """A figure that was drawn, in grey, blurred a little, its letters left out."""
    out = io.BytesIO()
    with house_style():
        letters = [text for text in figure.findobj(Text) if text.get_visible()]
        for text in letters:
            text.set_visible(False)
        figure.savefig(out, format="png", dpi=GOLDEN_DPI, metadata={"Software": None})
        for text in letters:
            text.set_visible(True)
    if os.environ.get("COURSE_UPDATE_GOLDEN"):
        (GOLDEN / f"{figure_id}.png").write_bytes(out.getvalue())
        (GOLDEN / f"{figure_id}.txt").write_text(letters_of(figure), encoding="utf-8")
    return grey(out)


def grey(picture: io.BytesIO | Path) -> np.ndarray:
    image = Image.open(picture).convert("L").filter(ImageFilter.BoxBlur(2))
    return np.asarray(image, dtype=float)


def letters_of(figure: Figure) -> str:
    """Everything written in a figure but the numbers at the axes, one text a line."""
    texts = [figure.get_suptitle()]
    for axes in figure.axes:
        texts += [axes.get_title(loc="left"), axes.get_xlabel(), axes.get_ylabel()]
        texts += [text.get_text().replace("\n", " ") for text in axes.texts]
    return "\n".join(filter(None, texts)) + "\n"


@pytest.mark.parametrize("figure_id", registry.figure_ids())
def test_a_figure_looks_as_it_did_when_somebody_last_looked_at_it(figure_id: str) -> None:
    looks = without_letters(built(figure_id), figure_id)
    golden = grey(GOLDEN / f"{figure_id}.png")
    assert looks.shape == golden.shape
    assert np.max(np.abs(looks - golden)) < TOLERANCE


@pytest.mark.parametrize("figure_id", registry.figure_ids())
def test_a_figure_says_what_it_did_when_somebody_last_read_it(figure_id: str) -> None:
    assert letters_of(built(figure_id)) == (GOLDEN / f"{figure_id}.txt").read_text(encoding="utf-8")


@pytest.mark.parametrize("figure_id", ["integrators-energy", "integrators-order", "integrators-phase"])
def test_the_tolerance_sees_one_method_drawn_as_another(
    figure_id: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    from course.figures import integrators

    swapped = {**integrators.STEPPERS, "explicit_euler": integrators.STEPPERS["semi_implicit_euler"]}
    monkeypatch.setattr(integrators, "STEPPERS", swapped)
    monkeypatch.delenv("COURSE_UPDATE_GOLDEN", raising=False)
    golden = grey(GOLDEN / f"{figure_id}.png")
    looks = without_letters(drawn(figure_id).figure, figure_id)
    assert np.max(np.abs(looks - golden)) > TOLERANCE


@pytest.mark.parametrize("figure_id", registry.figure_ids())
def test_a_figure_has_a_finding_for_a_title_and_axes_with_units(figure_id: str) -> None:
    figure = built(figure_id)
    assert figure.get_suptitle().count(" ") >= 5
    assert figure.get_figwidth() == WIDTH_IN
    labels = {axes.get_xlabel() for axes in figure.axes} | {axes.get_ylabel() for axes in figure.axes}
    assert all("(" in label for label in labels - {""}), labels
    assert any(axes.get_xlabel() for axes in figure.axes)


@pytest.mark.parametrize("figure_id", registry.figure_ids())
def test_no_text_of_a_figure_leaves_it_or_lies_on_other_text(figure_id: str) -> None:
    boxes, page = once(figure_id).words, built(figure_id).bbox
    assert all(page.x0 <= box.x0 and box.x1 <= page.x1 and box.y1 <= page.y1 for box in boxes)
    assert not [(a, b) for i, a in enumerate(boxes) for b in boxes[i + 1 :] if a.overlaps(b)]


def luminance(colour: str) -> float:
    parts = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def test_methods_differ_in_more_than_colour_and_their_names_are_legible_on_white() -> None:
    looks = METHODS.values()
    assert len({look.line for look in looks}) == len({look.marker for look in looks}) == len(METHODS)
    # WCAG 2.2, 1.4.3: letters need a contrast of 4.5 to 1.
    assert all(1.05 / (luminance(look.ink) + 0.05) >= 4.5 for look in looks)


def test_a_picture_is_the_same_bytes_twice() -> None:
    assert registry.png("integrators-stability", dpi=40) == registry.png("integrators-stability", dpi=40)


def test_a_readers_own_settings_do_not_reach_a_figure() -> None:
    import matplotlib as mpl

    before = registry.png("integrators-stability", dpi=40)
    with mpl.rc_context({"font.size": 20.0, "axes.facecolor": "red"}):
        assert registry.png("integrators-stability", dpi=40) == before


def test_a_figure_is_written_into_a_folder_that_is_made_for_it(tmp_path: Path) -> None:
    path = registry.save("integrators-stability", tmp_path / "new" / "figures", dpi=40)
    assert path == tmp_path / "new" / "figures" / "integrators-stability.png"
    assert path.read_bytes().startswith(b"\x89PNG")


def test_a_folder_that_cannot_be_written_to_is_a_usage_error(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way", encoding="utf-8")
    with pytest.raises(UsageError, match="cannot be written"):
        registry.save("integrators-stability", tmp_path / "file", dpi=40)


def test_an_unknown_figure_is_not_found() -> None:
    with pytest.raises(NotFoundError, match="no figure 'nothing'"):
        registry.build("nothing")


def test_asking_which_figures_there_are_loads_no_matplotlib() -> None:
    code = (
        "import sys; from course.figures.registry import figure_ids;"
        "figure_ids(); print('matplotlib' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"
