"""The figures: drawn as they were, legible and told apart by anyone, on a page and at the size of a terminal.

At the size of a terminal their words are letters of it, none on another.
"""

import functools
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

from course.errors import NotFoundError, UsageError
from course.figures import registry
from course.figures.looks import faults, picture_and_words
from course.figures.registry import build
from course.figures.style import METHODS, WIDTH_IN
from course.figures.terminal import in_cells

GOLDEN = Path(__file__).parents[2] / "fixtures" / "golden"


@pytest.mark.parametrize("figure_id", ["integrators-energy", "integrators-order", "integrators-phase"])
def test_the_tolerance_sees_one_method_drawn_as_another(figure_id, monkeypatch):
    from course.figures import integrators

    swapped = {**integrators.STEPPERS, "explicit_euler": integrators.STEPPERS["semi_implicit_euler"]}
    monkeypatch.setattr(integrators, "STEPPERS", swapped)
    (fault,) = [fault for fault in faults(figure_id, GOLDEN) if "looks other" in fault.problem]
    assert fault.help.endswith(f"course author pictures {figure_id}")


def drawn(change):
    """A builder of a figure that is right but for one change."""

    def builder():
        figure = Figure(figsize=(WIDTH_IN, 3.0), layout="constrained")
        axes = figure.subplots()
        figure.suptitle("One straight line that goes up steadily")
        axes.plot([0.0, 1.0], [0.0, 1.0])
        axes.set(xlabel="time (s)", ylabel="height (m)")
        change(figure, axes)
        return figure

    return builder


@pytest.mark.parametrize(
    ("change", "problem"),
    [
        (lambda figure, axes: 1 / 0, "cannot be drawn: ZeroDivisionError"),
        (lambda figure, axes: figure.suptitle("A line"), "no title that says what it shows"),
        (lambda figure, axes: figure.set_figwidth(9.0), "is 9 inches wide"),
        (lambda figure, axes: axes.set_xlabel("time / s"), "the label 'time / s' without a unit"),
        (lambda figure, axes: axes.set_xlabel(""), "no label below its axes"),
        (
            lambda figure, axes: axes.text(5.0, 0.5, "far away").set_in_layout(False),
            "'far away' outside of the page",
        ),
        (
            lambda figure, axes: [axes.text(0.5, 0.5, text) for text in ("one", "two")],
            "'one' written over 'two'",
        ),
    ],
)
def test_a_figure_that_cannot_be_drawn_or_read_is_found(tmp_path, monkeypatch, change, problem):
    from course.figures import integrators

    kept = tmp_path / "kept"
    kept.mkdir()
    monkeypatch.setattr(integrators, "phase_portraits", drawn(lambda figure, axes: None))
    picture, words = picture_and_words("integrators-phase")
    (kept / "integrators-phase.png").write_bytes(picture)
    (kept / "integrators-phase.txt").write_bytes(words)
    assert list(faults("integrators-phase", kept)) == []
    monkeypatch.setattr(integrators, "phase_portraits", drawn(change))
    assert any(problem in fault.problem for fault in faults("integrators-phase", kept))


def test_a_figure_that_nobody_looked_at_is_told_its_cure(tmp_path):
    (fault,) = faults("integrators-stability", tmp_path)
    assert "no picture to be compared with" in fault.problem
    assert "course author pictures integrators-stability" in fault.help
    assert fault.file.name == "integrators.py"
    assert (fault.line or 0) > 1


def luminance(colour):
    """By WCAG, computed anew, of red, green and blue from 0 to 255."""
    share = np.asarray(colour) / 255.0
    linear = np.where(share <= 0.03928, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
    return linear @ [0.2126, 0.7152, 0.0722]


def test_methods_differ_in_more_than_colour_and_their_names_are_legible_on_white():
    looks = METHODS.values()
    assert len({look.line for look in looks}) == len({look.marker for look in looks}) == len(METHODS)
    # WCAG 2.2, 1.4.3: letters need a contrast of 4.5 to 1.
    assert all(1.05 / (luminance(list(bytes.fromhex(look.ink[1:]))) + 0.05) >= 4.5 for look in looks)


def test_a_readers_own_settings_do_not_reach_a_figure():
    import matplotlib as mpl

    before = registry.png("integrators-stability")
    with mpl.rc_context({"font.size": 20.0, "axes.facecolor": "red"}):
        assert registry.png("integrators-stability") == before


def test_a_folder_that_cannot_be_written_to_is_a_usage_error(tmp_path):
    (tmp_path / "file").write_text("in the way", encoding="utf-8")
    with pytest.raises(UsageError, match="cannot be written"):
        registry.save("integrators-stability", tmp_path / "file")


def test_an_unknown_figure_is_not_found():
    with pytest.raises(NotFoundError, match="no figure 'nothing'"):
        registry.build("nothing")


def test_asking_which_figures_there_are_loads_no_matplotlib():
    code = (
        "import sys; from course.figures.registry import figure_ids;"
        "figure_ids(); print('matplotlib' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"


# -- at the size of a terminal ---------------------------------------------------------------------------

#: Quick to draw, and of every kind: several panels, logarithmic axes, maps, bars.
FIGURES = ["integrators-energy", "integrators-phase", "contact-stacks", "sim-free-fall", "engines-settings"]
ROWS = 17


@functools.cache
def shown(name, columns):
    """A figure, and what it is in so many cells: drawn once for all tests that look at it."""
    page = build(name)
    return page, in_cells(lambda: page, columns, ROWS)


@pytest.mark.parametrize("columns", [38, 76])
@pytest.mark.parametrize("name", FIGURES)
def test_words_lie_inside_and_never_on_each_other(name, columns):
    _, figure = shown(name, columns)
    assert figure.pixels.shape == (2 * ROWS, columns, 3)
    taken = set()
    for label in figure.labels:
        cells = {(label.row, label.column + at) for at in range(len(label.text))}
        assert not cells & taken, label
        taken |= cells
        assert 0 <= label.row < ROWS
        assert label.column >= 0
        assert label.column + len(label.text) <= columns
        assert not set("$\\{}") & set(label.text)


@pytest.mark.parametrize("name", FIGURES)
def test_the_finding_heads_it_and_both_axes_have_numbers(name):
    page, figure = shown(name, 76)
    assert figure.labels[0].text[:20] == page.get_suptitle().splitlines()[0][:20]
    numbers = [label for label in figure.labels if any(char.isdigit() for char in label.text)]
    assert len(numbers) >= 4


@pytest.mark.parametrize("name", [*FIGURES, "contact-tunnelling", "engines-speed", "twins-following"])
def test_every_word_can_be_read_on_what_is_drawn_under_it(name):
    """By WCAG 2.1's contrast, computed anew; the inks of the house have at least 3 on paper."""
    _, figure = shown(name, 76)
    for label in figure.labels:
        for at, letter in enumerate(label.text):
            under = figure.pixels[2 * label.row : 2 * label.row + 2, label.column + at].mean(axis=0)
            light, dark = sorted([luminance(label.ink), luminance(under)], reverse=True)
            assert letter == " " or (light + 0.05) / (dark + 0.05) >= 3.0, label


@pytest.mark.parametrize("name", ["engines-speed", "integrators-order", "twins-following"])
def test_no_axis_loses_its_name_on_a_small_screen(name):
    page, figure = shown(name, 76)
    names = [label for axes in page.axes for label in (axes.get_xlabel(), axes.get_ylabel()) if label]
    assert names
    letters = " ".join(label.text for label in figure.labels)
    for words in names:
        assert words.split(" (")[0].split("$")[0] in letters, words


def test_curves_are_seen_without_letters():
    """At least one pixel in fifty is neither paper nor a shade of grey."""
    pixels = shown("integrators-energy", 76)[1].pixels.astype(int)
    coloured = np.ptp(pixels, axis=2) > 60
    assert coloured.mean() > 0.02


def test_the_drawing_process_answers_each_request_on_a_line():
    asked = [
        {"id": 1, "figure": "sim-free-fall", "columns": 40, "rows": 10},
        {"id": 2, "figure": "no-such-figure", "columns": 40, "rows": 10},
    ]
    done = subprocess.run(
        [sys.executable, "-m", "course.figures.terminal"],
        input="".join(json.dumps(one) + "\n" for one in asked),
        capture_output=True,
        text=True,
        check=True,
    )
    first, second = map(json.loads, done.stdout.splitlines())
    assert (first["id"], second["id"]) == (1, 2)
    assert first["labels"]
    assert "no figure" in second["error"]
