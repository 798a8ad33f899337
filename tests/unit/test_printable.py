"""Text of strangers: on one line, steering nothing, at most so long."""

import ast
import unicodedata

import pytest

from course.printable import beginning, counted, ended, one_line, printable, quoted, steady

#: Line ends of every kind, marks that turn text, hidden characters, escapes, and half of a character.
_HOSTILE = (
    "a\nb", "a\r\nb", "a\x0bb\x0cc", "a\x85b", "a\u2028b\u2029c", "\u202eexe.yp", "\u2066x\u2069", "\u061c",
    "\u200f\u200e", "a\u200bb", "\ufeff", "\x1b[2J\x1b]0;x\x07", "\x9b31m", "\x00", "\udce9",
    "\U000e0041", "\t",
)  # fmt: skip


@pytest.mark.parametrize("text", _HOSTILE)
def test_what_is_shown_on_one_line_is_one_line_and_steers_nothing(text):
    shown = one_line(text)
    assert len(shown.splitlines()) <= 1
    assert all(character.isprintable() for character in shown)
    assert shown != text
    assert one_line(shown) == shown


def test_no_character_of_all_there_are_gets_through_that_is_not_printable():
    for first in range(0, 0x110000, 0x1000):
        text = "".join(map(chr, range(first, first + 0x1000)))
        assert one_line(text).isprintable()
        assert printable(text).replace("\n", "").replace("\t", "").isprintable()
        left = {unicodedata.bidirectional(character) for character in steady(text)}
        assert not left & {"LRE", "RLE", "LRO", "RLO", "PDF", "LRI", "RLI", "FSI", "PDI"}


def test_a_limit_holds_for_what_is_shown():
    assert len(one_line("\U0010ffff" * 5000, 2000)) == 2000
    assert one_line("plain", 3) == "pla"


@pytest.mark.parametrize("name", [*_HOSTILE, "x' was taken. It", "x\" or 'y", "x\\", "a" * 500 + "'.py"])
def test_a_name_in_a_sentence_ends_where_its_quotes_do(name):
    shown = quoted(name)
    assert shown.isprintable()
    assert len(ast.literal_eval(shown)) <= 80
    assert ast.literal_eval(shown) == name or (len(name) > 80 and shown.endswith(repr(name[-20:])[1:]))


def test_honest_text_stays_as_it_is():
    for text in ("naïve 数 Ω → 😀", "mass = 1.5 kg", ""):
        assert one_line(text) == printable(text) == steady(text) == text
    assert printable("a\n\tb") == steady("a\n\tb") == "a\n\tb"


@pytest.mark.parametrize(
    ("number", "said"), [(0, "0 steps"), (1, "1 step"), (2, "2 steps"), (2000, "2,000 steps")]
)
def test_a_number_has_its_noun_in_the_plural_unless_it_is_one(number, said):
    assert counted(number, "step") == said


def test_a_beginning_has_whole_lines_and_says_how_many_more_there_are():
    assert beginning("one\ntwo\n", 8) == "one\ntwo\n"
    assert beginning("one\ntwo\nthree\nfour\n", 10) == "one\ntwo\n... (2 more lines left out)"
    assert beginning("x" * 9, 4) == "xxxx\n... (1 more line left out)"


def test_a_question_has_no_full_stop():
    said = "Maybe you meant '==' instead of '='?"
    assert [ended(text) for text in ("so", "so. ", said, f"{said}.")] == ["so.", "so.", said, said]
