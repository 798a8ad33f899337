"""Likeness: copies are found whatever their names, the stub does not count, and nothing is run."""

from __future__ import annotations

import dataclasses
import itertools
import pathlib
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from course.catalog.load import Catalog
from course.grading.gradebook.records import Result
from course.grading.results.effective import Results
from course.grading.similar import (
    LONGEST,
    RUN,
    WINDOW,
    Document,
    Group,
    Pair,
    Parser,
    Prints,
    _blocks,
    _groups,
    _pairs,
    compare,
    fingerprints,
    page,
)
from course.scoring.judging.submission import Submission
from tests.growth import LIMIT, growth
from tests.unit.grading.conftest import MINI
from tests.unit.grading.made import RIGHT, key, make_book
from tests.unit.grading.pages import Page, faults

ORIGINAL = '''
def doublings(x, n):
    """Doubled again and again."""
    values = [x]
    for index in range(n):
        last = values[-1]
        if last > 0 or index % 2 == 0:
            values.append(last + last)
        else:
            values.append(-(abs(last) * 2))
    while len(values) < n + 1:
        values.append(None)
    return values


def double(x):
    result = x
    for _ in range(1):
        result = result + x
    return result
'''
RENAMED = '''
# mine, honestly
def double(number):
    """Something else."""
    total   = number
    for _unused in range( 1 ):
        total = (total
                 + number)
    return total

def doublings(start, times):
    out = [start]
    for k in range(times):
        previous = out[-1]
        if previous > 0 or k % 2 == 0: out.append(previous + previous)
        else: out.append(-(abs(previous) * 2))
    while len(out) < times + 1:
        out.append(None)
    return out
'''
OTHER = """
import numpy as np

def double(x):
    return np.multiply(x, 2)

def doublings(x, n):
    if n == 0:
        return np.array([x])
    return np.concatenate([[x], doublings(double(x), n - 1)])

class Helper:
    def __init__(self, a):
        self.a = a
    def run(self, b):
        return {key: value for key, value in zip(self.a, b)}
"""


def class_of(tmp_path: Path, sources: dict[str, str | bytes]):
    book = make_book(tmp_path, {})
    for student, source in sources.items():
        content = source if isinstance(source, bytes) else source.encode()
        files = {"doubling.py": content}
        where = dataclasses.replace(key(student), submission_sha256=Submission(files).sha256)
        book.add(Result(where, RIGHT), files)
    return book


def test_a_copy_with_other_names_layout_and_order_is_found(tmp_path: Path, catalog: Catalog) -> None:
    stub = catalog.exercise("doubling").stub_path.read_text("utf-8")
    sources = {"ada": ORIGINAL, "bob": RENAMED, "cy": OTHER, "dan": stub, "eve": stub + "\n\nx = 1\n"}
    with class_of(tmp_path, sources) as book:
        found = compare(Results(book), catalog, (), at_least=0.6)
    pairs = {frozenset((pair.first.label, pair.second.label)): pair for pair in found.pairs}
    assert frozenset(("ada", "bob")) in pairs
    assert pairs[frozenset(("ada", "bob"))].share > 0.95
    assert not [both for both in pairs if "cy" in both]
    assert not [both for both in pairs if both & {"dan", "eve"}], "what the stub gave is nobody's"
    assert found.compared == 5


def test_what_the_stub_gave_is_nobodys(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from course.catalog.load import Catalog

    shutil.copytree(MINI, tmp_path / "course")
    (tmp_path / "course" / "exercises" / "doubling" / "doubling.py").write_text(ORIGINAL, "utf-8")
    monkeypatch.setenv("COURSE_CONTENT", str(tmp_path / "course"))
    sources = {"ada": ORIGINAL + "def own():\n" + BLOCK, "bob": ORIGINAL + OTHER, "cy": ORIGINAL}
    with class_of(tmp_path / "out", sources) as book:
        assert compare(Results(book), Catalog(), (), at_least=0.3).pairs == []


def test_what_the_course_itself_has_is_recognised(tmp_path: Path, catalog: Catalog) -> None:
    import course.physics.integrators as textbook

    assert textbook.__file__ is not None
    with class_of(
        tmp_path, {"ada": pathlib.Path(textbook.__file__).read_bytes() + b"\nx = 1\n", "cy": OTHER}
    ) as book:
        found = compare(Results(book), catalog, (), at_least=0.6)
    assert [(pair.first.label, pair.second.label) for pair in found.pairs] == [
        ("ada", "course.physics.integrators")
    ]


def test_every_module_that_a_student_has_is_the_courses_own(tmp_path: Path, catalog: Catalog) -> None:
    """Another exercise's checks and what the lessons run, not only this exercise's files and the textbook."""
    import course.simulations.experiments.dynamics as shown

    assert shown.__file__ is not None
    other = MINI / "exercises" / "halving" / "checks.py"
    copied = {"ada": pathlib.Path(shown.__file__), "bob": other}
    sources = {name: path.read_bytes() for name, path in copied.items()}
    with class_of(tmp_path, {**sources, "cy": OTHER}) as book:
        found = compare(Results(book), catalog, (), at_least=0.6)
    pairs = {(pair.first.label, pair.second.label) for pair in found.pairs}
    assert pairs == {
        ("ada", "course.simulations.experiments.dynamics"),
        ("bob", "exercises/halving/checks.py"),
    }


def test_many_copies_of_one_file_are_all_found_without_all_pairs(tmp_path: Path, catalog: Catalog) -> None:
    sources = {f"student {number:03}": ORIGINAL + f"# {number}\n" for number in range(60)}
    with class_of(tmp_path, sources) as book:
        found = compare(Results(book), catalog, ("doubling",), at_least=0.6)
    assert {pair.share for pair in found.pairs} == {1.0}
    named = {label for pair in found.pairs for label in (pair.first.label, pair.second.label)}
    assert named == sources.keys()
    assert len(found.pairs) == 59


def test_what_an_exercise_ships_beside_its_stub_is_recognised(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from course.catalog.load import Catalog

    shutil.copytree(MINI, tmp_path / "course")
    (tmp_path / "course" / "exercises" / "doubling" / "helper.py").write_text(ORIGINAL, "utf-8")
    monkeypatch.setenv("COURSE_CONTENT", str(tmp_path / "course"))
    with class_of(tmp_path / "out", {"ada": ORIGINAL + "x = 1\n", "cy": OTHER}) as book:
        found = compare(Results(book), Catalog(), (), at_least=0.6)
    assert [(pair.first.label, pair.second.label) for pair in found.pairs] == [
        ("ada", "the exercise's helper.py")
    ]


def test_copies_do_not_keep_others_off_the_list(tmp_path: Path, catalog: Catalog) -> None:
    """Of a few copies, too, each is listed with the first; and that one with whoever is nearly the same."""
    sources = {f"a {number}": ORIGINAL + f"# {number}\n" for number in range(8)}
    sources |= {"near": ORIGINAL.replace("return", "print('done')\n    return", 1)}
    model = (MINI / "solutions" / "doubling" / "doubling.py").read_text("utf-8")
    sources |= {f"model {number}": model + f"# {number}\n" for number in range(3)}
    with class_of(tmp_path, sources) as book:
        found = compare(Results(book), catalog, ("doubling",), at_least=0.6)
    pairs = {(pair.first.label, pair.second.label) for pair in found.pairs}
    assert pairs == {
        *(("a 0", f"a {number}") for number in range(1, 8)),
        ("a 0", "near"),
        *((f"model {number}", "the model solution") for number in range(3)),
    }
    (group,) = found.groups
    assert group.members == (*(f"a {number}" for number in range(8)), "near")
    assert group.share == min(pair.share for pair in found.pairs if not pair.second.own) < 1
    table = Page(page(found)).tables["Submissions linked by similar pairs, the largest group first"]
    assert [name.strip() for name in table[1][0].split(",")] == list(group.members)
    assert table[1][1:] == ["doubling", "9", f"{100 * group.share:.0f}\u00a0%"]


def test_right_solutions_of_the_course_share_little_with_the_model_solution(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The default of ``--share`` rests on it, and docs/instructor.md says it."""
    from course.catalog.load import Catalog

    monkeypatch.delenv("COURSE_CONTENT", raising=False)
    catalog, most = Catalog(), 0.0
    assert catalog.content.solutions is not None
    with Parser() as parse:
        for name in catalog.exercise_ids():
            exercise, folder = catalog.exercise(name), catalog.content.solutions / name
            files = [folder / exercise.module, *sorted((folder / "accepted").glob("*.py"))]
            documents = [Document(file.name, "", parse(file.read_bytes())) for file in files]
            ignored = set(parse(exercise.stub_path.read_bytes()).marks)
            shares = {
                (pair.first.label, pair.second.label): pair.share
                for pair in _pairs(name, documents, ignored, 0.0)
            }
            most = max([most, *(share for both, share in shares.items() if exercise.module in both)])
    assert 0.38 < most < 0.395


def test_pairs_make_groups_by_exercise_and_the_courses_own_code_connects_nobody() -> None:
    def pair(first: str, second: str, share: float, exercise: str = "doubling") -> Pair:
        sides = (Document(label, "", Prints({}, "", 0), own=label == "own") for label in (first, second))
        return Pair(exercise, *sides, share, (), 1)

    chain = [pair("a", "b", 1.0), pair("c", "d", 0.7), pair("d", "b", 0.9)]
    others = [pair("x", "own", 1.0), pair("y", "own", 1.0), pair("a", "own", 1.0), pair("e", "f", 1.0)]
    elsewhere = [pair("a", "e", 0.8, "halving"), pair("f", "e", 0.8, "halving")]
    for ordered in itertools.permutations(chain):
        assert _groups([*others, *ordered, *elsewhere]) == [
            Group("doubling", ("a", "b", "c", "d"), 0.7),
            Group("halving", ("a", "e", "f"), 0.8),
        ]


def test_sources_that_hurt_the_parser_are_named_and_the_rest_compared(
    tmp_path: Path, catalog: Catalog
) -> None:
    bad = {
        "syntax": b"def (",
        "nul": b"\x00",
        "bytes": b"\xff\xfe",
        "parentheses": b"(" * 5000,
        "minus": b"x = " + b"-" * 200_000 + b"1",
        "plus": b"x = " + b"1+" * 100_000 + b"1",
    }
    with class_of(tmp_path, {"ada": ORIGINAL, "bob": RENAMED, **bad}) as book:
        found = compare(Results(book), catalog, (), at_least=0.6)
    assert [{pair.first.label, pair.second.label} for pair in found.pairs] == [{"ada", "bob"}]
    assert {"syntax doubling", "nul doubling", "parentheses doubling"} <= set(found.unreadable)
    assert found.compared + len(found.unreadable) == 2 + len(bad)


def test_a_source_that_is_too_long_is_named_and_never_parsed(tmp_path: Path, catalog: Catalog) -> None:
    long = ORIGINAL + "#" * LONGEST
    with class_of(tmp_path, {"ada": ORIGINAL, "bob": RENAMED, "long": long}) as book:
        found = compare(Results(book), catalog, (), at_least=0.6)
    assert found.unreadable == ["long doubling"]
    assert [{pair.first.label, pair.second.label} for pair in found.pairs] == [{"ada", "bob"}]


def _backwards(size: int) -> Callable[[], int]:
    """Two who hand in the same functions, one of them backwards: nothing continues anything."""
    passages = [((10 * n, 10 * n + 1), (10 * (size - n), 10 * (size - n) + 1)) for n in range(size)]
    return lambda: len(_blocks(passages))


def test_passages_in_reversed_order_are_not_joined() -> None:
    assert _backwards(500)() == 500


@pytest.mark.soak
def test_passages_in_reversed_order_are_compared_in_time_that_grows_with_their_number() -> None:
    assert growth(_backwards, 500) < LIMIT


def test_a_process_that_parses_ends_when_its_time_is_used_up() -> None:
    """By CPU time: on a busy machine an honest source has six times as long by the wall clock."""
    spins = "from course.grading.pipes import limit_cpu\nlimit_cpu(0)\nwhile True:\n    pass"
    done = subprocess.run([sys.executable, "-c", spins], check=False)
    assert done.returncode == -signal.SIGXCPU


def test_a_source_is_never_run(tmp_path: Path) -> None:
    trap = f"open({str(tmp_path / 'ran')!r}, 'w').close()\n"
    with Parser() as parse:
        assert parse(trap.encode()) is not None
    assert not (tmp_path / "ran").exists()


def test_the_page_shows_text_as_text(tmp_path: Path, catalog: Catalog) -> None:
    evil = "# <script>alert(1)</script> \u202e\n" + ORIGINAL
    with class_of(tmp_path, {"<b>ada</b>": evil, "bob&co": RENAMED}) as book:
        text = page(compare(Results(book), catalog, (), at_least=0.5))
    assert "<script" not in text
    assert "\u202e" not in text
    assert "<b>ada" not in text
    assert "&lt;b&gt;ada&lt;/b&gt;" in text
    assert "bob&amp;co" in text
    assert '<span class="alike">' in text
    assert "http" not in text.replace("http-equiv", "")
    assert faults(Page(text), scripted=False) == [], "every passage leads to the same one opposite"
    assert 'href="#p1-b-1"' in text


def test_right_solutions_that_were_written_differently_are_not_alike(monkeypatch: pytest.MonkeyPatch) -> None:
    """The course's own unusual solutions; the default of ``--share`` lies between them and a copy."""
    from course.catalog.load import Catalog

    monkeypatch.delenv("COURSE_CONTENT", raising=False)
    catalog = Catalog()
    assert catalog.content.solutions is not None
    shares: list[float] = []
    for exercise in catalog.exercises():
        paths = sorted((catalog.content.solutions / exercise.id / "accepted").glob("*.py"))
        found = [fingerprints(path.read_bytes()) for path in paths]
        prints = [item.marks.keys() for item in found if item is not None and len(item.marks) >= 10]
        for one, other in itertools.combinations(prints, 2):
            shares.append(len(one & other) / min(len(one), len(other)))
    assert len(shares) > 20
    assert max(shares) < 0.5


BLOCK = "".join(f"    a{n} = b{n}[{n}] + c(d, {n})\n" for n in range(12))


@settings(max_examples=30)
@given(st.lists(st.sampled_from(["x = 1", "y += f(x)", "if x: pass", "z = [q for q in x]"]), max_size=12))
def test_a_long_shared_passage_is_never_missed(before: list[str]) -> None:
    """Winnowing's promise: any passage of RUN + WINDOW - 1 nodes leaves a common mark."""
    one = fingerprints(("def f():\n" + BLOCK).encode())
    other = fingerprints(("\n".join(before) + "\ndef g():\n" + BLOCK).encode())
    assert one is not None
    assert other is not None
    assert one.nodes > RUN + WINDOW
    assert one.marks.keys() & other.marks.keys()
