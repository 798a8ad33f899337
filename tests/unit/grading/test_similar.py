"""Likeness: copies are found whatever their names, the stub does not count, and nothing is run."""

import dataclasses
import itertools
import signal
import subprocess
import sys
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
    Prints,
    _blocks,
    _groups,
    _pairs,
    compare,
    fingerprints,
    page,
)
from course.physics import integrators
from course.scoring.judging.submission import Submission
from course.simulations.experiments import dynamics
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


def class_of(tmp_path, sources):
    book = make_book(tmp_path, {})
    for student, source in sources.items():
        content = source if isinstance(source, bytes) else source.encode()
        files = {"doubling.py": content}
        where = dataclasses.replace(key(student), submission_sha256=Submission(files).sha256)
        book.add(Result(where, RIGHT), files)
    return book


BLOCK = "".join(f"    a{n} = b{n}[{n}] + c(d, {n})\n" for n in range(12))
BOB = "<b>bob&co</b>"
#: What hurts the parser.
BAD = {
    "syntax": b"def (",
    "nul": b"\x00",
    "bytes": b"\xff\xfe",
    "parentheses": b"(" * 5000,
    "minus": b"x = " + b"-" * 200_000 + b"1",
    "plus": b"x = " + b"1+" * 100_000 + b"1",
    "long": ORIGINAL.encode() + b"#" * LONGEST,
}


@pytest.fixture(scope="module")
def ran(tmp_path_factory):
    """What a source would leave, were it run."""
    return tmp_path_factory.mktemp("ran") / "ran"


@pytest.fixture(scope="module")
def found(tmp_path_factory, catalog, ran):
    """A copy under hostile names, the stub, modules that a student has of the course, and what is no code."""
    stub = catalog.exercise("doubling").stub_path.read_text("utf-8")
    sources = {
        "ada": ORIGINAL,
        BOB: "# <script>alert(1)</script> \u202e\n" + RENAMED,
        "cy": f"open({str(ran)!r}, 'w').close()\n{OTHER}",
        "dan": stub,
        "eve": stub + "\n\nx = 1\n",
        "tom": Path(integrators.__file__).read_bytes() + b"\nx = 1\n",
        "uli": Path(dynamics.__file__).read_bytes(),
        "vic": (MINI / "exercises" / "halving" / "checks.py").read_bytes(),
    }
    with class_of(tmp_path_factory.mktemp("class"), sources | BAD) as book:
        return compare(Results(book), catalog, (), at_least=0.6)


def test_copies_of_a_student_or_of_what_the_course_itself_has_are_found_and_nothing_else(found, ran):
    """Whatever the names, the layout and the order; of the course not only this exercise and the textbook."""
    pairs = {(pair.first.label, pair.second.label): pair for pair in found.pairs}
    assert pairs.keys() == {
        (BOB, "ada"),
        ("tom", "course.physics.integrators"),
        ("uli", "course.simulations.experiments.dynamics"),
        ("vic", "exercises/halving/checks.py"),
    }, "what the stub gave is nobody's"
    assert pairs[BOB, "ada"].share > 0.95
    assert not ran.exists(), "a source is never run"


def test_a_line_that_is_no_python_hides_no_copy():
    whole, broken = (fingerprints(f"{ORIGINAL}{more}".encode()) for more in ("", "\nthis is no python (\n"))
    assert broken.marks.keys() >= whole.marks.keys()


def test_sources_that_hurt_the_parser_or_are_too_long_are_named_and_the_rest_compared(found):
    assert {f"{name} doubling" for name in ("syntax", "nul", "parentheses", "long")} <= set(found.unreadable)
    assert set(found.unreadable) <= {f"{name} doubling" for name in BAD}
    assert found.compared + len(found.unreadable) == 8 + len(BAD)


def test_the_page_shows_text_as_text(found):
    text = page(found)
    assert "<script" not in text
    assert "\u202e" not in text
    assert "<b>bob" not in text
    assert "&lt;b&gt;bob&amp;co&lt;/b&gt;" in text
    assert '<span class="alike">' in text
    assert "http" not in text.replace("http-equiv", "")
    assert faults(Page(text), scripted=False) == [], "every passage leads to the same one opposite"
    assert 'href="#p1-b-1"' in text


def test_what_the_stub_gave_is_nobodys_and_what_lies_beside_it_is_the_courses(tmp_path, copied):
    exercise = copied / "exercises" / "doubling"
    (exercise / "doubling.py").write_text(ORIGINAL, "utf-8")
    (exercise / "helper.py").write_text(OTHER, "utf-8")
    sources = {"ada": ORIGINAL + OTHER, "bob": ORIGINAL + "def own():\n" + BLOCK, "cy": ORIGINAL}
    with class_of(tmp_path / "out", sources) as book:
        pairs = compare(Results(book), Catalog(), (), at_least=0.3).pairs
    assert [(pair.first.label, pair.second.label) for pair in pairs] == [("ada", "the exercise's helper.py")]


def test_copies_do_not_keep_others_off_the_list(tmp_path, catalog):
    """Each copy is listed with the first alone, and that one with whoever is nearly the same.

    Of more copies than may propose a pair, too, and where the first is the course's own.
    """
    sources = {f"a {number}": ORIGINAL + f"# {number}\n" for number in range(8)}
    sources |= {"near": ORIGINAL.replace("return", "print('done')\n    return", 1)}
    model = (MINI / "solutions" / "doubling" / "doubling.py").read_text("utf-8")
    sources |= {f"model {number}": model + f"# {number}\n" for number in range(45)}
    with class_of(tmp_path, sources) as book:
        found = compare(Results(book), catalog, ("doubling",), at_least=0.6)
    pairs = {(pair.first.label, pair.second.label) for pair in found.pairs}
    assert pairs == {
        *(("a 0", f"a {number}") for number in range(1, 8)),
        ("a 0", "near"),
        *((f"model {number}", "the model solution") for number in range(45)),
    }
    (group,) = found.groups
    assert group.members == (*(f"a {number}" for number in range(8)), "near")
    assert group.share == min(pair.share for pair in found.pairs if not pair.second.own) < 1
    table = Page(page(found)).tables["Submissions linked by similar pairs, the largest group first"]
    assert [name.strip() for name in table[1][0].split(",")] == list(group.members)
    assert table[1][1:] == ["doubling", "9", f"{100 * group.share:.0f}\u00a0%"]


def test_right_solutions_share_little_with_the_model_solution_and_with_each_other(monkeypatch):
    """The default of ``--share`` lies between them and a copy, and docs/instructor.md says it."""
    monkeypatch.delenv("COURSE_CONTENT", raising=False)
    catalog, with_model, with_others = Catalog(), [], []
    for name in catalog.exercise_ids():
        exercise, folder = catalog.exercise(name), catalog.content.solutions / name
        files = [folder / exercise.module, *sorted((folder / "accepted").glob("*.py"))]
        documents = [Document(file.name, "", fingerprints(file.read_bytes())) for file in files]
        ignored = set(fingerprints(exercise.stub_path.read_bytes()).marks)
        with_model += [
            pair.share
            for pair in _pairs(name, documents, ignored, 0.0)
            if exercise.module in {pair.first.label, pair.second.label}
        ]
        prints = [one.prints.marks.keys() for one in documents[1:] if len(one.prints.marks) >= 10]
        with_others += [len(a & b) / min(len(a), len(b)) for a, b in itertools.combinations(prints, 2)]
    assert 0.38 < max(with_model) < 0.395
    assert len(with_others) > 20
    assert max(with_others) < 0.5


def test_pairs_make_groups_by_exercise_and_the_courses_own_code_connects_nobody():
    def pair(first, second, share, exercise="doubling"):
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


def _backwards(size):
    """Two who hand in the same functions, one of them backwards: nothing continues anything."""
    passages = [((10 * n, 10 * n + 1), (10 * (size - n), 10 * (size - n) + 1)) for n in range(size)]
    return lambda: len(_blocks(passages))


def test_passages_in_reversed_order_are_not_joined():
    assert _backwards(500)() == 500


def _crowded(size):
    """One who hands in all on one line, and one who has a gap after each passage of it."""
    passages = [((1, 1), (10 * n, 10 * n + 1)) for n in range(size)]
    return lambda: len(_blocks(passages))


@pytest.mark.soak
@pytest.mark.parametrize("passages", [_backwards, _crowded])
def test_passages_that_nothing_joins_are_compared_in_time_that_grows_with_their_number(passages):
    assert growth(passages, 500) < LIMIT


def test_a_process_that_parses_ends_when_its_time_is_used_up():
    """By CPU time: on a busy machine an honest source has six times as long by the wall clock."""
    spins = "from course.grading.pipes import limit_cpu\nlimit_cpu(0)\nwhile True:\n    pass"
    done = subprocess.run([sys.executable, "-c", spins], check=False)
    assert done.returncode == -signal.SIGXCPU


PASSAGE = fingerprints(("def f():\n" + BLOCK).encode())


@settings(max_examples=30)
@given(st.lists(st.sampled_from(["x = 1", "y += f(x)", "if x: pass", "z = [q for q in x]"]), max_size=12))
def test_a_long_shared_passage_is_never_missed(before):
    """Winnowing's promise: any passage of RUN + WINDOW - 1 nodes leaves a common mark."""
    one = PASSAGE
    other = fingerprints(("\n".join(before) + "\ndef g():\n" + BLOCK).encode())
    assert one.nodes > RUN + WINDOW
    assert one.marks.keys() & other.marks.keys()
