"""Reading Python without running it."""

import ast
from pathlib import Path

import pytest

from course.authoring.exercises.source import checks_in, foreign_imports, quoted_numbers, signatures


def test_signatures_are_compared_without_annotations():
    tree = ast.parse("def f(a: int, *, b: float = 1.0, **kw: str) -> int: ...\nclass C: ...\n")
    assert signatures(tree)["f"].text == "f(a, *, b=1.0, **kw)"
    assert signatures(tree)["f"].annotated == "f(a: int, *, b: float=1.0, **kw: str)"
    assert set(signatures(tree)) == {"f"}


def test_the_last_definition_of_a_function_counts():
    assert signatures(ast.parse("def f(a): ...\ndef f(b): ...\n"))["f"].text == "f(b)"


def test_imports_are_found_wherever_they_stand():
    source = "import os\nimport numpy.linalg\ndef f():\n    from scipy import fft\nfrom . import x\n"
    assert list(foreign_imports(ast.parse(source), ("numpy",))) == [(5, "."), (4, "scipy")]


def test_a_check_is_what_its_markers_say():
    source = (
        "@pytest.mark.task('t')\n@pytest.mark.points(1.5)\n@pytest.mark.requires('a', 'b')\n"
        "def test_x(submission):\n    '''Title\n\n    more'''\n\ndef helper(): ...\n"
    )
    (check,) = checks_in(Path("c.py"), ast.parse(source), hidden=True)
    assert (check.id, check.title, check.line, check.hidden) == ("x", "Title", 4, True)
    assert (check.task, check.points, check.requires) == ("t", 1.5, ("a", "b"))


def test_a_marker_that_is_no_plain_value_is_told_from_a_missing_one():
    source = (
        "@pytest.mark.task(T)\n@pytest.mark.requires(*ALL)\ndef test_x(): ...\n"
        "@pytest.mark.points(1 + 1)\n@pytest.mark.task('t')\ndef test_y(): ...\n"
    )
    x, y = checks_in(Path("c.py"), ast.parse(source), hidden=False)
    assert (x.task, x.points, x.indirect) == (None, None, ("task", "requires"))
    assert (y.task, y.points, y.indirect) == ("t", None, ("points",))


@pytest.mark.parametrize(
    ("call", "numbers"),
    [
        ("kit.fail('off by 0.25')", ["0.25"]),
        ("kit.expect_true(x, 'more than 1e-9')", ["1e-9"]),
        ("kit.expect_close(a, 0.25, message='no', help='yes')", []),
        ("kit.expect_close(a, b, message=f'{a} is not 2.5')", ["2.5"]),
        ("kit.Diagnosis('X', 'about 3.0 of them', 'less')", ["3.0"]),
        ("kit.Diagnosis(code='X', looks_like='l', advice='use 1.5E+3')", ["1.5E+3"]),
        ("kit.expect_close(a, b, source='seen 0.3 to 0.4')", []),
        ("kit.fail('RK4 of order 4, in 2 steps, see v1.2.3')", []),
    ],
)
def test_numbers_in_the_words_of_a_check_are_found(call, numbers):
    assert [number for _, number in quoted_numbers(ast.parse(call))] == numbers
