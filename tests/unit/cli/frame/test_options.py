"""Global options stand anywhere on the line, up to a double dash."""

from __future__ import annotations

import itertools

import pytest

from course.cli.frame.options import global_options


def test_every_order_of_all_of_them_means_the_same():
    for order in itertools.permutations(["--json", "--plain", "-q", "check", "integrators"]):
        line = global_options(order)
        assert (line.settings.json, line.settings.plain, line.settings.quiet) == (True, True, True)
        assert line.rest == tuple(word for word in order if not word.startswith("-"))


def test_a_double_dash_ends_the_search():
    line = global_options(["check", "--", "--json", "-C"])
    assert not line.settings.json
    assert line.rest == ("check", "--", "--json", "-C")
    assert not line.problem


@pytest.mark.parametrize("words", [["-C", "a/b", "check"], ["check", "-Ca/b"], ["-Ca", "check", "-C", "b"]])
def test_the_folder_may_be_attached_and_two_add_up(words):
    line = global_options(words)
    assert line.settings.directory in {"a/b", "a\\b"}
    assert line.rest == ("check",)
