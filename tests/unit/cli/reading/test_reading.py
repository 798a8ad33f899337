"""A lesson on the screen and for a screen reader."""

import io
import re
from pathlib import Path

import pytest
from rich.console import Console

from course.catalog.models import Lesson
from course.cli.frame.pictures import protocol_of
from course.cli.reading.lesson import paginate, printer, sentences, value_spoken, value_text
from course.reading.parts import read_script, words_of
from tests.unit.cli.conftest import Said
from tests.unit.cli.reading.conftest import CATALOG

TEXT = """+++
ignored = true
+++

Opening words with $h\\omega$ and [4.4e8](=x) in *one* line.

A long paragraph has words enough to fill more than one line of the widest screen that anybody would read a \
lesson on, and then a few more of them, so that it has to be wrapped wherever it is shown.

> **Myth.** All is well.

## First section

| method | order |
|:--|--:|
| a rather long name | 1 |
| b | $z^2$ |

> **Predict.** What comes out?

```python
print("four", 2 + 2)
```

```output
four 4
```

```python hidden
x = 1
```

![Two lines that cross at one](figure:integrators-stability)
They cross.

> **Answer.** Four. Then [more](lesson:engines) of it.

## Second section

1. one
2. two

$$
q_{n+1} = q_n
$$

```mermaid
flowchart LR
  accDescr: A leads to B.
  A --> B
```

```drawing
A ──▶ B
```

```console
$ course check integrators  # looks at your file
```

## Sources

- E. Hairer, *A book*, 2003. [example.org](https://example.org)
"""


@pytest.fixture
def lesson(tmp_path):
    path = tmp_path / "a-lesson.md"
    path.write_text(TEXT, encoding="utf-8")
    return Lesson(1, "a-lesson", "A lesson", 5, "What it is.", ("do this",), (), ("an-exercise",), str(path))


def only(lesson, text):
    """The same lesson, which says nothing else."""
    Path(lesson.path).write_text(f"+++\n+++\n\n{text}", encoding="utf-8")
    return lesson


def console_of(width=60, **options):
    return Console(file=io.StringIO(), width=width, markup=False, emoji=False, highlight=False, **options)


def written(console):
    return console.file.getvalue()


def shown(lesson, width=60, **options):
    console = console_of(width)
    read_whole(lesson, console, **options)
    return written(console)


def read_whole(lesson, console, **options):
    """All of it; the pictures that were written."""
    script = read_script(lesson)
    prints = printer(CATALOG, script, console, **options)
    prints.head()
    prints.blocks(script.blocks)
    return prints.pictures


@pytest.mark.parametrize("width", [40, 60, 80, 120])
def test_no_line_is_wider_than_the_screen_or_than_prose_should_be_or_ends_in_blanks(lesson, width):
    lines = shown(lesson, width).splitlines()
    assert max(map(len, lines)) <= min(width, 80)
    assert not [line for line in lines if line != line.rstrip()]
    assert any(re.fullmatch(r"  method +order", line) for line in lines), "a table that fits breaks no word"
    assert "…" not in "".join(lines)
    assert shown(lesson, width, plain=True) == shown(lesson, 20, plain=True), "no line is broken to a width"


def test_the_screen_shows_what_is_there_with_a_name_and_a_figure_by_its_caption(lesson):
    text = shown(lesson)
    for part in (
        "hω", "4.4 × 10⁸", "z²", 'print("four", 2 + 2)', "four 4", "qₙ₊₁ = qₙ", "A ──▶ B",
        "$ course check integrators\n      looks at your file", "more (course lesson engines)", "1. one",
        "Then practise: course start an-exercise", "┃ Myth\n  ┃ All is well.", "Figure 1. They cross.",
        "To be seen: Two lines that cross at one", "course lesson a-lesson --figures DIR",
    ):  # fmt: skip
        assert part in text
    assert "x = 1" not in text, "a hidden cell"


@pytest.mark.parametrize("width", range(30, 60))
def test_a_short_formula_is_never_broken_over_two_lines(lesson, width):
    text = "The growth of it all is $1 + z^2$ on each step."
    assert "1 + z²" in shown(only(lesson, text), width)


@pytest.mark.parametrize("plain", [False, True])
def test_figures_are_written_where_asked_and_their_path_is_said(lesson, tmp_path, plain):
    console = console_of(400)
    (picture,) = read_whole(lesson, console, plain=plain, figures_dir=tmp_path / "f")
    assert picture == tmp_path / "f" / "integrators-stability.png"
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert f"Picture:{picture}" in "".join(written(console).split())


def test_a_diagram_and_a_formula_too_wide_for_the_screen_are_said_in_words(lesson):
    """At 40 columns the right half of a diagram was missing, and nothing said so."""
    drawing = "one ──── two ──── three ──── four ──── five"
    text = f"""
```mermaid
flowchart LR
    accDescr: One leads to five.
    one --> five
```

```drawing
{drawing}
```

$$
q_{{n+1}} = q_n + h v_n + h a_n + h b_n + h c_n + h d_n + h e_n
$$
"""
    narrow, wide = (" ".join(shown(only(lesson, text), width).split()) for width in (40, 80))
    facts = ("Diagram: One leads to five.", "───", drawing, "accDescr", "plus h a sub n")
    assert [fact in narrow for fact in facts] == [True, False, False, False, True]
    assert [fact in wide for fact in facts] == [False, True, True, False, False]


def test_a_table_too_wide_for_the_screen_becomes_facts(lesson):
    words = ("extraordinarily", "incomprehensible", "circumstantially")
    only(lesson, f"| {' | '.join(words)} |\n|--|--|--|\n| one | two | three |\n")
    assert "incomprehensible: two" in shown(lesson, 40)
    assert "incomprehensible: two" not in shown(lesson, 80)


def test_plain_is_words_only(lesson):
    text = shown(lesson, 60, plain=True)
    assert not set(text) & set("─│┃┌▶•ωₙ²")
    assert "x = 1" not in text, "a hidden cell"
    for line in (
        "Myth: All is well.",
        "Opening words with h omega and 4.4 times 10 to the power 8 in one line.",
        "Section: First section",
        "Row 2",
        "order: z squared",
        "Formula: q sub n plus 1 end sub equals q sub n",
        "Diagram: A leads to B.",
        "Step 1: one",
        "Try: course check integrators",
        "What it does: looks at your file",
        "It prints, 1 line:",
        "Source 1: E. Hairer, A book, 2003. example.org",
    ):
        assert f"{line}\n" in text


def test_a_terminal_that_cannot_show_the_letters_gets_what_a_screen_reader_gets(lesson):
    ascii_file = io.TextIOWrapper(io.BytesIO(), encoding="ascii", errors="replace")
    read_whole(lesson, Console(file=ascii_file, width=60, markup=False))
    ascii_file.seek(0)
    assert "Section: First section" in ascii_file.read()


def test_colour_is_left_out_where_it_is_not_wanted(lesson, monkeypatch):
    monkeypatch.setenv("TERM", "xterm-256color")
    coloured = console_of(60, force_terminal=True, color_system="256")
    quiet = console_of(60, force_terminal=True, color_system="256", no_color=True)
    for console in (coloured, quiet):
        read_whole(lesson, console)
    colours = re.compile(r"\x1b\[[\d;]*\b3[1-7]\b[\d;]*m")
    assert colours.search(written(coloured))
    assert not colours.search(written(quiet))


def test_without_colour_code_keeps_its_marks(lesson):
    for no_color, said in ((True, "It takes `steps` steps."), (False, "It takes steps steps.")):
        console = console_of(60, no_color=no_color)
        read_whole(only(lesson, "It takes `steps` steps."), console)
        assert said in written(console)


def test_a_page_ends_where_a_section_or_a_prediction_does_whose_answer_it_does_not_show(lesson):
    pages = paginate(read_script(lesson).blocks)
    said = ["\n".join(map(words_of, page)) for page in pages]
    begins = ["Opening words", "First section", "print", "Second section", "Sources"]
    assert all(text.startswith(words) for text, words in zip(said, begins, strict=True))
    assert "What comes out?" in said[1]
    assert "four 4" not in said[1]


@pytest.mark.parametrize(
    ("environ", "protocol"),
    [
        ({"KITTY_WINDOW_ID": "1"}, "kitty"),
        ({"TERM_PROGRAM": "ghostty"}, "kitty"),
        ({"TERM_PROGRAM": "iTerm.app"}, "iterm2"),
        ({"TERM_PROGRAM": "WezTerm"}, "iterm2"),
        ({"TERM": "xterm-kitty"}, "kitty"),
        ({"TERM": "xterm-256color"}, None),
        ({"KONSOLE_VERSION": "210801"}, None),
        ({"KITTY_WINDOW_ID": "1", "TMUX": "/tmp/tmux"}, None),
        ({"KITTY_WINDOW_ID": "1", "TERM": "dumb"}, None),
        (None, None),
    ],
)
def test_pictures_are_shown_only_where_the_terminal_is_known_to_show_them(environ, protocol):
    """And never through a pipe."""
    console = console_of(force_terminal=environ is not None)
    assert protocol_of(console, environ or {"KITTY_WINDOW_ID": "1"}) == protocol


def test_a_picture_is_sent_to_a_terminal_that_shows_it(lesson, monkeypatch):
    monkeypatch.setenv("KITTY_WINDOW_ID", "1")
    for name in ("TMUX", "STY", "ZELLIJ"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("TERM", "xterm-kitty")
    console = console_of(60, force_terminal=True)
    read_whole(lesson, console)
    Said(written(console)).says_in_order("\x1b_Ga=T,f=100", "They cross.").lacks("To be seen")


def test_sentences_end_at_full_stops_and_not_at_initials():
    ones = ["One by E. Hairer.", '"Two" at 0.5 s!', "Three?", "(Four.)"]
    assert sentences(" ".join(ones)) == ones


@pytest.mark.parametrize(
    ("text", "on_screen", "spoken"),
    [
        ("-0.0981", "−0.0981", "minus 0.0981"),
        ("1e-14", "10⁻¹⁴", "1 times 10 to the power minus 14"),
        ("4.4e8 J", "4.4 × 10⁸ J", "4.4 times 10 to the power 8 J"),
        ("180,000", "180,000", "180,000"),
    ],
)
def test_a_number_is_written_and_spoken_as_people_do(text, on_screen, spoken):
    assert (value_text(text), value_spoken(text)) == (on_screen, spoken)
