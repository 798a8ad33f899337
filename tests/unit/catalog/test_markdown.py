"""Lessons: Markdown in, typed blocks out, all else refused with its place; formulae as text and as words."""

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from course.catalog import blocks as b
from course.catalog.markdown import parse_lesson, read_blocks
from course.catalog.mathtext import MathError, math_spoken, math_text
from course.catalog.reading import split_front_matter
from course.errors import ContentError

FILE = Path("a-lesson.md")


def parse(text):
    return parse_lesson(text, FILE)


def only(text):
    blocks = parse(text)
    assert len(blocks) == 1
    return blocks[0]


def test_front_matter_is_parted_from_the_text_and_the_line_of_the_text_is_known():
    head = split_front_matter("+++\nid = 'a'\n+++\n\n## One\n", FILE)
    assert head == ("id = 'a'", "\n## One\n", 4)


@pytest.mark.parametrize("text", ["", "## One\n", "+++\nid = 'a'\n"])
def test_a_lesson_without_a_whole_front_matter_is_refused(text):
    with pytest.raises(ContentError, match=r"a-lesson\.md:1: the front matter"):
        split_front_matter(text, FILE)


def test_a_file_that_is_not_utf8_is_refused(tmp_path):
    path = tmp_path / "latin.md"
    path.write_bytes("+++\n+++\nkäse".encode("latin-1"))
    with pytest.raises(ContentError, match=r"latin\.md:3: the file is not UTF-8 text"):
        read_blocks(path)


def test_lines_are_those_of_the_file():
    blocks = parse_lesson("\nOne.\n\nTwo.\n", FILE, first_line=10)
    assert [block.line for block in blocks] == [11, 13]


def test_a_line_of_prose_keeps_its_pieces():
    block = only("Some *soft* **loud** `code` $h\\omega$ and [words](https://a.org).")
    assert isinstance(block, b.Paragraph)
    assert block.inlines == (
        b.Text("Some "),
        b.Span("emphasis", (b.Text("soft"),)),
        b.Text(" "),
        b.Span("strong", (b.Text("loud"),)),
        b.Text(" "),
        b.Span("code", (b.Text("code"),)),
        b.Text(" "),
        b.Formula("h\\omega", "hω", "h omega"),
        b.Text(" and "),
        b.Link("https://a.org", (b.Text("words"),), 1),
        b.Text("."),
    )
    assert b.plain_text(block.inlines) == "Some soft loud code hω and words."


def test_lines_of_a_paragraph_are_joined_by_a_space():
    block = only("one\ntwo")
    assert isinstance(block, b.Paragraph)
    assert block.inlines == (b.Text("one two"),)


@pytest.mark.parametrize(
    ("target", "expression"),
    [
        ('=error["a"]', 'error["a"]'),
        ("=f(1,2)", "f(1,2)"),
        ("<=a + b * 2>", "a + b * 2"),
        ("=100*x", "100*x"),
    ],
)
def test_a_link_to_an_expression_is_a_value(target, expression):
    block = only(f"It is [0.0890]({target}) m.")
    assert isinstance(block, b.Paragraph)
    assert block.inlines[1] == b.Value("0.0890", expression, 1)


@pytest.mark.parametrize("target", ["lesson:one", "exercise:one#a-heading", "#here", "https://a.org/b"])
def test_links_inside_the_course_and_to_the_web_are_links(target):
    block = only(f"[words]({target})")
    assert isinstance(block, b.Paragraph)
    assert block.inlines == (b.Link(target, (b.Text("words"),), 1),)


def test_lists_hold_blocks_and_numbered_ones_know_their_first_number():
    bullets, numbers = parse("- one\n- two\n  - deeper\n\ntext\n\n3. three\n")[::2]
    assert isinstance(bullets, b.ListBlock)
    assert bullets.start is None
    assert isinstance(bullets.items[1][1], b.ListBlock)
    assert isinstance(numbers, b.ListBlock)
    assert numbers.start == 3


def test_a_table_knows_its_header_rows_and_alignment():
    table = only("| a | b |\n|:--|--:|\n| 1 | $x^2$ |\n")
    assert isinstance(table, b.Table)
    assert table.align == ("left", "right")
    assert table.header == ((b.Text("a"),), (b.Text("b"),))
    assert table.rows == (((b.Text("1"),), (b.Formula("x^2", "x²", "x squared"),)),)


def test_output_belongs_to_the_cell_above_it():
    cell = only("```python\nprint(4)\n```\n\n```output\n4\n```\n")
    assert cell == b.CodeCell(1, "print(4)", "4", output_line=5)


def test_a_hidden_cell_is_marked():
    cell = only("```python hidden\nx = 1\n```\n")
    assert isinstance(cell, b.CodeCell)
    assert cell.hidden


def test_a_formula_on_its_own_takes_the_forms_its_author_gives():
    given_forms = "$$\n\\oint x\n% text: around x\n% spoken: once round\n% spoken: and back\n$$\n"
    assert only(given_forms) == b.MathBlock(1, "\\oint x", "around x", "once round\nand back")


def test_a_diagram_has_three_forms():
    text = "```mermaid\nflowchart LR\n  accDescr: A leads to B.\n  A --> B\n```\n\n```drawing\nA -> B\n```\n"
    diagram = only(text)
    assert isinstance(diagram, b.Diagram)
    assert (diagram.drawing, diagram.description) == ("A -> B", "A leads to B.")


def test_a_figure_has_an_id_an_alternative_and_a_caption():
    figure = only("![Two lines that cross at one](figure:lines)\nThey *cross*.\n")
    expected = (b.Text("They "), b.Span("emphasis", (b.Text("cross"),)), b.Text("."))
    assert figure == b.Figure(1, "lines", "Two lines that cross at one", expected)


def test_a_quote_with_a_label_is_a_passage_with_a_role():
    myth, question = parse("> **Myth.** All is well.\n\nText\n\n> **Predict:** What now?\n> - a\n> - b\n")[
        ::2
    ]
    assert myth == b.Callout(1, "myth", (b.Paragraph(1, (b.Text("All is well."),)),))
    assert isinstance(question, b.Prediction)
    assert isinstance(question.blocks[1], b.ListBlock)


def test_commands_are_read_with_their_notes():
    block = only("```console\n$ course check a  # why\n$ course lessons\n```\n")
    assert block == b.CommandList(1, (b.Command("course check a", "why"), b.Command("course lessons", "")))


def test_the_list_under_sources_is_a_list_of_sources():
    sources = parse("## Sources\n\n- A. Author, *Title*, 2003.\n")[1]
    assert isinstance(sources, b.Sources)
    assert b.plain_text(sources.items[0]) == "A. Author, Title, 2003."


REFUSED = {
    "# Title": "a heading of level 1",
    "> ## Inside": "a heading inside",
    "<b>bold</b>": "HTML has no form",
    "<div>\n</div>": "HTML has no form",
    "> quoted": "without a known label",
    "> **Mith.** x": "without a known label",
    "```\nx\n```": "a fence marked 'nothing'",
    "```rust\nx\n```": "a fence marked 'rust'",
    "```text\nx\n\nand the rest of the lesson": "a fence that is never closed",
    "```output\n4\n```": "follows no shown code cell",
    "```python hidden\nx\n```\n\n```output\n4\n```": "follows no shown code cell",
    "```drawing\nx\n```": "follows no diagram",
    "```mermaid\nflowchart\n```": "has no description",
    "```mermaid\naccDescr: a\n```": "has no drawing",
    "```console\ncourse lessons\n```": "not a command",
    "[x](http://a.org)": "a link to",
    "[x](other.md)": "a link to",
    "![short](figure:a)\nCaption": "no alternative text",
    "![long enough to be of some use](figure:a)": "no caption",
    "![long enough to be of some use](a.png)\nCaption": "is not a figure",
    "text ![long enough to be of some use](figure:a)": "inside a paragraph",
    "$\\oint x$": "has no text form",
    "## Sources\n\n- A. Author, Title.": "has no date",
    "***": "a lesson has no hr",
    "    indented": "a lesson has no code block",
}


@pytest.mark.parametrize(("text", "problem"), REFUSED.items())
def test_what_a_lesson_cannot_hold_is_refused_with_its_place(text, problem):
    with pytest.raises(ContentError) as caught:
        parse_lesson(f"First.\n\n{text}\n", FILE, first_line=20)
    assert problem in caught.value.problem
    assert caught.value.line in (22, 23, 24, 26)
    assert caught.value.help


@settings(max_examples=200)
@given(st.lists(st.sampled_from([*REFUSED, "", "text", "- item", "> **Fact.** x", "$$\nx\n$$", "+++"])))
def test_any_text_gives_blocks_or_an_error_with_a_line(parts):
    try:
        lines = [block.line for block in b.walk_blocks(parse("\n\n".join(parts)))]
    except ContentError as error:
        lines = [error.line or 0]
    assert all(line >= 1 for line in lines)


def test_a_heading_is_an_anchor():
    heading = only("## Where the *energy* goes, $h\\omega$")
    assert isinstance(heading, b.Heading)
    assert b.slug(heading) == "where-the-energy-goes-hω"


# -- formulae --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("tex", "text"),
    [
        (r"h\omega", "hω"),
        (r"\ddot\theta = -\omega^2 \theta", "θ̈ = −ω²θ"),
        (r"q_{n+1} = q_n + h\,v_n", "qₙ₊₁ = qₙ + h vₙ"),
        (r"\frac{z}{2-z}", "z/(2 − z)"),
        (r"\frac{a+b}{2}", "(a + b)/2"),
        (r"\frac{1}{2}v^2", "½v²"),
        (r"\frac{h}{2}\,a_n", "(h/2) aₙ"),
        (r"2\sqrt{2}", "2√2"),
        (r"\sqrt{1+z^2}", "√(1 + z²)"),
        (r"\|x\| + \left|y\right|", "‖x‖ + |y|"),
        (r"J^\top \Omega J", "JᵀΩJ"),
        (r"e^{-h\omega}", "e^(−hω)"),
        (r"g h t", "g h t"),
        (r"\omega\cos\omega t", "ω cos ωt"),
        (r"\cos(\omega t)", "cos(ωt)"),
        (r"3\,\text{m/s}", "3 m/s"),
        (r"v_{\text{max}}", "vₘₐₓ"),
        (r"x < -2", "x < −2"),
    ],
)
def test_a_formula_keeps_in_text_what_typesetting_says_by_position(tex, text):
    assert math_text(tex) == text


@pytest.mark.parametrize(
    ("tex", "spoken"),
    [
        (r"\omega^2", "omega squared"),
        (r"q_{n+1} + h", "q sub n plus 1 end sub plus h"),
        (r"\frac{z}{2-z}", "the fraction z over 2 minus z end fraction"),
        (r"\frac{h}{2}\,a", "the fraction h over 2 end fraction a"),
        (r"a = -4", "a equals negative 4"),
        (r"2\sqrt{2}", "2 times the square root of 2"),
        (r"\|e\| \le h", "the norm of e end norm is at most h"),
        (r"\sum_i m_i", "the sum over i of m sub i"),
    ],
)
def test_a_formula_is_unambiguous_when_spoken(tex, spoken):
    assert math_spoken(tex) == spoken


def test_the_lines_of_an_aligned_formula_stay_lines_with_their_relations_in_one_column():
    tex = r"\begin{aligned} a &= b \\ a+a &= c \end{aligned}"
    assert [row.index("=") for row in math_text(tex).splitlines()] == [6, 6]
    assert math_spoken(tex) == "a equals b\na plus a equals c"


@pytest.mark.parametrize(
    "tex",
    [
        r"\oint x",
        "a_b_c",
        "{a",
        "a}",
        r"\left(a",
        r"\left a",
        "^2",
        r"\hat{ab}",
        r"\begin{cases}a\end{cases}",
        "é",
        # People would read these two ways.
        r"\frac12 x",
        "x^10",
        "a/2b",
        r"h/2\,v",
    ],
)
def test_what_the_converter_does_not_know_is_refused(tex):
    with pytest.raises(MathError):
        math_text(tex)


_PIECES = st.sampled_from(
    [
        *"a2+-=/(){}|&",
        "x_1",
        "^2",
        "_n",
        "\\\\",
        r"\frac",
        r"\sqrt",
        r"\omega",
        r"\dot",
        r"\left(",
        r"\right)",
        r"\,",
        r"\text{in m}",
        r"\begin{aligned}",
        r"\end{aligned}",
        r"\what",
    ]
)


@given(st.lists(_PIECES, max_size=12).map(" ".join))
def test_any_formula_gives_clean_text_or_is_refused(tex):
    try:
        text, spoken = math_text(tex), math_spoken(tex)
    except MathError:
        return
    assert not set(text) & set("\\{}$&")
    assert not set(spoken) & set("\\{}$&^_")
