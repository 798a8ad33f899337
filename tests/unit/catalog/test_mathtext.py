"""Formulae as text and as words."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from course.catalog.mathtext import MathError, math_spoken, math_text


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
