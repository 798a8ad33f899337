"""Lines of values in TOML texts."""

import json
import tomllib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from course.catalog.reading import LineMap, parse_path, syntax_error_line

TEXT = '''\
# a comment with = and [brackets]
title = "one"
"quoted.key" = 1
a.b.c = 2

[table]
text = """
[not.a.table]
key = "not a key"
"""
list = [
    1,
    # between
    [2, 3], {x = 4, w = [
    0], "y z" = 5},
]

[[task]]
id = "first" # [[task]]
points = 1

[[task]]
id = 'second'
points = 2
  [[task.part]]
  name = "p"
  [[task.part]]
  name = "q"
  [task.part.more]
  deep = true
'''


@pytest.mark.parametrize(
    ("path", "line"),
    [
        (("title",), 2),
        (("quoted.key",), 3),
        (("a",), 4),
        (("a", "b", "c"), 4),
        (("table",), 6),
        (("table", "text"), 7),
        (("table", "list"), 11),
        (("table", "list", 0), 12),
        (("table", "list", 1), 14),
        (("table", "list", 1, 1), 14),
        (("table", "list", 2, "x"), 14),
        (("table", "list", 2, "y z"), 15),
        (("task", 0), 18),
        (("task", 0, "points"), 20),
        (("task", 1, "id"), 23),
        (("task", 1, "part", 0, "name"), 26),
        (("task", 1, "part", 1, "name"), 28),
        (("task", 1, "part", 1, "more", "deep"), 30),
    ],
)
def test_each_value_is_found_on_its_line(path, line):
    assert LineMap(TEXT).line(path) == line


def test_a_missing_value_is_placed_at_what_surrounds_it():
    lines = LineMap(TEXT)
    assert lines.line(("task", 1, "title")) == 22
    assert lines.line(("nothing", "at", "all")) == 1


def test_lines_are_counted_from_where_the_text_starts_in_its_file():
    assert LineMap("a = 1\nb = 2\n", first_line=10).line(("b",)) == 11


def test_windows_line_ends_count_once():
    assert LineMap('a = """x\r\ny"""\r\nb = 2\r\n').line(("b",)) == 3


@pytest.mark.parametrize(
    ("text", "steps"),
    [
        ("$", ()),
        ("$.task[2].points", ("task", 2, "points")),
        ("$.imports[0]", ("imports", 0)),
        ("$.table[...].x", ("table",)),
    ],
)
def test_paths_are_read_as_msgspec_writes_them(text, steps):
    assert parse_path(text) == steps


@pytest.mark.parametrize(("text", "line"), [("a = 1\nb = \nc = 3\n", 2), ("a = 1\nb = [1,\n", 2), ("= 1", 1)])
def test_a_syntax_error_has_a_line(text, line):
    with pytest.raises(tomllib.TOMLDecodeError) as caught:
        tomllib.loads(text)
    assert syntax_error_line(caught.value, text) == line


words = st.text(st.characters(codec="ascii", exclude_categories=["Cc"]), max_size=6)
leaves = st.one_of(st.integers(-9, 99), st.booleans(), words)
values = st.recursive(
    leaves, lambda inner: st.one_of(st.lists(inner, max_size=3), st.dictionaries(words, inner, max_size=3))
)
tables = st.lists(
    st.tuples(st.booleans(), st.dictionaries(words, values, max_size=3)), min_size=1, max_size=4
)


def _dump(value, spread):
    """One value as TOML; ``spread`` puts each item of a list on a line of its own."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(k)} = {_dump(v, False)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        gap = "\n" if spread else " "
        return f"[{gap}" + f",{gap}".join(_dump(item, spread) for item in value) + "]"
    return json.dumps(value)


def _leaves(value, path):
    yield path, value
    if isinstance(value, dict):
        for key, item in value.items():
            yield from _leaves(item, (*path, key))
    elif isinstance(value, list):
        for index, item in enumerate(value):
            yield from _leaves(item, (*path, index))


@given(tables)
def test_any_document_is_mapped_completely_and_in_order(document):
    """Every value has a line, at which the text holds it, and no line lies before the value's table."""
    rows = []
    for spread, table in document:
        rows.append("[[item]]")
        rows += [f"{json.dumps(key)} = {_dump(value, spread)}" for key, value in table.items()]
    text = "\n".join(rows) + "\n"
    data = tomllib.loads(text)
    lines = LineMap(text)
    source = text.split("\n")
    for index, table in enumerate(data["item"]):
        start = lines.line(("item", index))
        assert source[start - 1] == "[[item]]"
        for path, value in _leaves(table, ("item", index)):
            line = lines.line(path)
            assert line >= start
            if isinstance(path[-1], str):
                assert f"{json.dumps(path[-1])} = " in source[line - 1]
            elif not isinstance(value, list | dict):
                assert json.dumps(value) in source[line - 1]
