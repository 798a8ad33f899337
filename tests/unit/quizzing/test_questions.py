"""Reading question files: every mistake is a sentence with file, line and fix."""

import pytest

from course.catalog.questions import read_questions
from course.errors import ContentError


def broken(quiz, old, new, name="sums.toml"):
    """The error after the first ``old`` in a file was replaced; it must be about this file."""
    path = quiz / name
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(ContentError) as caught:
        read_questions(quiz)
    assert caught.value.file == path
    assert caught.value.help
    return caught.value


def line_of(quiz, text, name="sums.toml"):
    return (quiz / name).read_text(encoding="utf-8").split("\n").index(text) + 1


@pytest.mark.parametrize(
    ("old", "new", "problem"),
    [
        ("format_version = 1", "format_version = 2", "format 2"),
        ('id = "sums"', 'id = "Sums"', "not a valid question id"),
        ('id = "sums"', 'id = "summen"', "the file is called sums.toml"),
        ("order = 1", "order = 0", "1 or more"),
        ("order = 1", "order = 2", "the order 2 too"),
        ('title = "Sums"', 'title = " "', "`title` is empty"),
        ('title = "Sums"', 'titel = "Sums"', "unknown key `titel`"),
        ('counts-on = "A sum is the next number."', 'counts-on = ""', "`counts-on` is empty"),
        ("counts-on =", '"Counts On" =', "not a valid name of a misconception"),
        ('id = "apples"', 'id = "numbers"', "variant numbers is there twice"),
        ('id = "none"', 'id = "next"', "option next is there twice"),
        ('id = "none"', 'id = "a"', "the letter a"),
        ('id = "none"', 'id = "No!"', "not a valid name of a option"),
        ('text = "Nothing"', 'text = ""', "`text` is empty"),
        ('explanation = "Neither number is nothing."', 'explanation = " "', "`explanation` is empty"),
        ('source = "computed"', 'source = ""', "`source` is empty"),
        ("right = true\n", "", "0 right options"),
        ('misconception = "counts-on"\n', "right = true\n", "2 right options"),
        ('misconception = "counts-on"\n', "", "it names none"),
        ('misconception = "counts-on"\n', 'misconception = "counts-of"\n', "'counts-of' is not among them"),
        ("right = true\n", 'right = true\nmisconception = "counts-on"\n', "the right option names"),
        ('name = "b", values', 'name = "a", values', "'a' is not a new, valid name"),
        ('name = "b", values', 'name = "b c", values', "'b c' is not a new, valid name"),
        ("values = [3.0, 4.5]", "values = []", "needs either `values` or `formula`"),
        ("values = [3.0, 4.5]", 'values = [3], formula = "a"', "needs either `values` or `formula`"),
        ("values = [3.0, 4.5]", "values = [3, 3.0]", "repeats one"),
        ("values = [3.0, 4.5]", "values = [3, nan]", "nan or inf"),
        ('formula = "a + 1"', 'formula = "a +"', "not a formula"),
        ('formula = "a + 1"', 'formula = "next + 1"', "uses next, which is not given above it"),
        ("digits = 3", "digits = 0", "between 1 and 6"),
        ("What is {a} and {b}?", "What is {a} and {c}?", "{c} names no number"),
        ("What is {a} and {b}?", "What is {a} and {?", "a brace stands alone"),
        ('text = "{next} in all"', 'text = "Many"', "number next is used nowhere"),
        ("values = [3.0, 4.5]", f"values = {[*range(200)]}", "600 cases"),
    ],
)
def test_a_mistake_is_named(quiz, old, new, problem):
    assert problem in broken(quiz, old, new).message


def test_a_mistake_is_pointed_at(quiz):
    where = line_of(quiz, '  { name = "next", formula = "a + 1" },')
    assert broken(quiz, 'formula = "a + 1"', 'formula = "a + z"').line == where


def test_a_missing_option_is_counted(quiz):
    old = '  { id = "dark", text = "Dark", misconception = "by-night", explanation = "By night only." },\n'
    error = broken(quiz, old, "", "colours.toml")
    assert "variant grass has 3 options" in error.message
    assert error.line == line_of(quiz, "[[variant]]", "colours.toml")
