"""Figures and code on a terminal: that what is sent is the figure, and where a long line goes on."""

import base64
import io
import re
from functools import partial

import numpy as np
import pytest
from matplotlib.image import imread
from PIL import Image
from rich.console import Console

from course.cli.frame.pictures import Code, picture
from course.figures.described import Panel, Plot, Series
from course.figures.plots import draw, render
from course.figures.terminal import in_cells

PLOT = Plot(
    title="A line", panels=(Panel("time / s", "height / m", (Series("", [0.0, 1.0, 2.0], [0.0, 1.0, 4.0]),)),)
)
make = partial(draw, PLOT)


def terminal(**given):
    defaults = {"file": io.StringIO(), "force_terminal": True, "color_system": "truecolor", "width": 60}
    return Console(**defaults | given)


def test_kitty_s_and_iterm_s_bytes_are_the_figure():
    """Kitty's arrive in chunks of 4096."""
    console = terminal()
    console.print(picture(console, {"KITTY_WINDOW_ID": "1"}, make, 60))
    chunks = re.findall(r"\x1b_G([^;]*);([^\x1b]*)\x1b\\", console.file.getvalue())
    assert [head for head, _ in chunks] == ["a=T,f=100,q=2,c=60,m=1", *["m=1"] * (len(chunks) - 2), "m=0"]
    assert all(len(data) <= 4096 for _, data in chunks)
    same(base64.b64decode("".join(data for _, data in chunks)))
    console = terminal()
    console.print(picture(console, {"TERM_PROGRAM": "iTerm.app"}, make, 60))
    head, data = re.search(r"\x1b\]1337;File=([^:]*):([^\x07]*)\x07", console.file.getvalue()).groups()
    sent = base64.b64decode(data)
    assert head == f"inline=1;size={len(sent)};width=60;preserveAspectRatio=1"
    same(sent)


@pytest.mark.parametrize(
    "environ", [{"TERM": "foot-extra"}, {"KONSOLE_VERSION": "230805"}], ids=["foot", "Konsole"]
)
def test_sixels_are_the_figure(environ):
    console = terminal()
    console.print(picture(console, environ, make, 60))
    (sent,) = re.findall(r"\x1bP(.*?)\x1b\\", console.file.getvalue(), re.DOTALL)
    decoded = from_sixels(sent)
    assert decoded.shape[1] == 600  # the VT340's ten pixels a letter, since a file has no size
    whole = Image.open(io.BytesIO(render(PLOT))).convert("RGB")
    figure = whole.resize(decoded.shape[1::-1], Image.Resampling.LANCZOS)
    # 255 colours for the figure's 600 or so, each said in percent: off by 2.55 / 2 alone.
    assert np.abs(decoded - np.asarray(figure)).mean() < 2
    assert np.quantile(np.abs(decoded - np.asarray(figure)), 0.99) < 20


def from_sixels(sent):
    """The pixels that a terminal would show, decoded by the manual and not by what encoded them."""
    head, body = sent.split("q", 1)
    assert head == "0;1;0"
    width, height = map(int, re.match(r'"1;1;(\d+);(\d+)', body).groups())
    pixels = np.full((height + 6, width, 3), -1.0)
    colours, column, row = {}, 0, 0
    for token in re.findall(r'"[\d;]+|#\d+(?:;2;\d+;\d+;\d+)?|!\d+.|.', body):
        if token[0] == '"':
            continue
        if token[0] == "#":
            number, *definition = map(int, token[1:].split(";"))
            if definition:
                colours[number] = np.array(definition[1:]) * 2.55
            ink = colours[number]
        elif token == "$":
            column = 0
        elif token == "-":
            column, row = 0, row + 6
        else:
            count = int(token[1:-1]) if token[0] == "!" else 1
            for bit in range(6):
                if ord(token[-1]) - 63 >> bit & 1:
                    pixels[row + bit, column : column + count] = ink
            column += count
    assert (pixels[:height] >= 0).all()  # every pixel was named
    assert (pixels[height:] < 0).all()
    return pixels[:height]


def same(sent):
    """The pixels that were sent are those of the file that a report writes."""
    assert np.array_equal(imread(io.BytesIO(sent)), imread(io.BytesIO(render(PLOT))))


@pytest.mark.parametrize("width", [40, 60, 100])
def test_half_blocks_are_the_figure_as_wide_as_asked_and_say_what_it_says(width):
    console = terminal(width=width)
    console.print(picture(console, {}, make, width))
    drawn = in_cells(make, width)
    upper, lower = np.zeros((drawn.rows, width, 3)), np.zeros((drawn.rows, width, 3))
    blocks, words = np.zeros((drawn.rows, width), bool), []
    for row, line in enumerate(console.file.getvalue().splitlines()):
        shown = list(cells(line))
        assert len(shown) == width
        words.append("".join(letter for letter, _, _ in shown))
        for column, (letter, ink, paper) in enumerate(shown):
            blocks[row, column] = letter == "▀"
            upper[row, column], lower[row, column] = ink, paper
    assert "A line" in words[0]
    assert any("time / s" in row for row in words)
    assert blocks.mean() > 0.7  # the rest are letters
    assert np.array_equal(upper[blocks], drawn.pixels[0::2][blocks])
    assert np.array_equal(lower[blocks], drawn.pixels[1::2][blocks])


def cells(line):
    """(letter, ink, paper) of each cell of a line in 24-bit colour."""
    ink = paper = (0, 0, 0)
    for code, letter in re.findall(r"\x1b\[([0-9;]*)m|(.)", line):
        if letter:
            yield letter, ink, paper
            continue
        if found := re.search(r"38;2;(\d+);(\d+);(\d+)", code):
            ink = tuple(map(int, found.groups()))
        if found := re.search(r"48;2;(\d+);(\d+);(\d+)", code):
            paper = tuple(map(int, found.groups()))


@pytest.mark.parametrize(
    "given",
    [
        {"no_color": True},
        {"color_system": "standard"},
        {"force_terminal": False},
        {"file": io.TextIOWrapper(io.BytesIO(), encoding="ascii")},
    ],
    ids=["NO_COLOR", "16 colours", "no terminal", "no letters beyond ASCII"],
)
def test_where_nothing_can_be_seen_nothing_is_drawn(given):
    def never():
        raise AssertionError("drawn for nobody")

    assert picture(terminal(**given), {}, never, 60) is None


@pytest.fixture
def coloured(monkeypatch):
    """A terminal with colours."""
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("TERM", "xterm-256color")
    monkeypatch.setenv("COLORTERM", "truecolor")
    monkeypatch.delenv("KITTY_WINDOW_ID", raising=False)
    monkeypatch.delenv("TERM_PROGRAM", raising=False)


def test_a_simulation_is_drawn_on_a_terminal_and_only_there(course, coloured, monkeypatch):
    assert "▀" in course("sim run projectile").out
    for words in (("--plain",), ("--quiet",), ("--json",)):
        ran = course("sim run projectile", *words)
        assert "▀" not in ran.out + ran.err
    monkeypatch.setenv("NO_COLOR", "1")
    assert "▀" not in course("sim run projectile").out


def test_a_report_is_drawn_on_a_terminal_and_described_besides(course, workspace, coloured):
    assert course("start doubling").code in {0, 1}
    (workspace / "doubling" / "doubling.py").write_text(
        "import numpy as np\n\n\ndef double(x):\n    return 2 * x\n\n\n"
        "def doublings(x, n):\n    return x * 2.0 ** np.arange(n + 1)\n"
    )
    course("report doubling").says("▀", "Figure: Five points")
    assert "▀" not in course("report doubling --plain").out


@pytest.mark.parametrize(
    ("source", "width", "rows"),
    [
        ("total = first_of_all + second_of_all", 24, ["total = first_of_all +", "  ↳ second_of_all"]),
        ("    " + "x" * 30, 24, ["    " + "x" * 20, "      ↳ " + "x" * 10]),
        ("'" + "積" * 12 + "'", 20, ["'" + "積" * 9, "  ↳ " + "積" * 3 + "'"]),
        ("if x:\n\n    return 1\n", 12, ["if x:", "", "    return 1"]),
        ("    a = one + two + three + four", 18, ["    a = one + two", "      ↳ + three +", "      ↳ four"]),
    ],
    ids=["between words", "where it must", "letters of two columns", "as wide as the window", "further in"],
)
def test_a_line_breaks_between_words_where_it_can(source, width, rows):
    console = Console(width=width, file=io.StringIO())
    console.print(Code(source))
    assert console.file.getvalue().splitlines() == rows
