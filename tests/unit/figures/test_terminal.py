"""Figures at the size of a terminal: their words are letters of it, none on another."""

import functools
import json
import subprocess
import sys

import numpy as np
import pytest

from course.figures.registry import build
from course.figures.terminal import in_cells

#: Quick to draw, and of every kind: several panels, logarithmic axes, maps, bars.
FIGURES = ["integrators-energy", "integrators-phase", "contact-stacks", "sim-free-fall", "engines-settings"]
ROWS = 17


@functools.cache
def drawn(name, columns):
    """A figure, and what it is in so many cells: drawn once for all tests that look at it."""
    page = build(name)
    return page, in_cells(lambda: page, columns, ROWS)


@pytest.mark.parametrize("columns", [38, 76])
@pytest.mark.parametrize("name", FIGURES)
def test_words_lie_inside_and_never_on_each_other(name, columns):
    _, figure = drawn(name, columns)
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
    page, figure = drawn(name, 76)
    assert figure.labels[0].text[:20] == page.get_suptitle().splitlines()[0][:20]
    numbers = [label for label in figure.labels if any(char.isdigit() for char in label.text)]
    assert len(numbers) >= 4


@pytest.mark.parametrize("name", [*FIGURES, "contact-tunnelling", "engines-speed", "twins-following"])
def test_every_word_can_be_read_on_what_is_drawn_under_it(name):
    """By WCAG 2.1's contrast, computed anew; the inks of the house have at least 3 on paper."""

    def luminance(colour):
        share = np.asarray(colour) / 255.0
        linear = np.where(share <= 0.03928, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
        return linear @ [0.2126, 0.7152, 0.0722]

    _, figure = drawn(name, 76)
    for label in figure.labels:
        for at, letter in enumerate(label.text):
            under = figure.pixels[2 * label.row : 2 * label.row + 2, label.column + at].mean(axis=0)
            light, dark = sorted([luminance(label.ink), luminance(under)], reverse=True)
            assert letter == " " or (light + 0.05) / (dark + 0.05) >= 3.0, label


@pytest.mark.parametrize("name", ["engines-speed", "integrators-order", "twins-following"])
def test_no_axis_loses_its_name_on_a_small_screen(name):
    page, figure = drawn(name, 76)
    names = [label for axes in page.axes for label in (axes.get_xlabel(), axes.get_ylabel()) if label]
    assert names
    shown = {label.text for label in figure.labels}
    for words in names:
        assert words.split(" (")[0].split("$")[0] in " ".join(shown), words


def test_curves_are_seen_without_letters():
    """At least one pixel in fifty is neither paper nor a shade of grey."""
    pixels = drawn("integrators-energy", 76)[1].pixels.astype(int)
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
