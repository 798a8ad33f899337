"""Regrading: who changes, by how much, by which check; and nothing is lost."""

import json
import shutil
import subprocess
import sys

import msgspec
import pytest

from course.catalog.load import Catalog
from course.errors import IntegrityError, MissingCapabilityError
from course.grading.container import write_autograder
from course.grading.gradebook.records import Key, Result
from course.grading.results.effective import Results, override
from course.grading.running.batch import Graded
from course.grading.running.rerun import RerunOptions, rerun
from course.grading.running.run import edited_since
from course.scoring.graders import grader_version
from tests.unit.grading.made import BROKEN, HALF, REFUSED, RIGHT, WRONG, digest, key, make_book

pytestmark = pytest.mark.usefixtures("unpacked")

NOW = {"ada": RIGHT, "bob": HALF, "cy": RIGHT, "dan": RIGHT}


class Graders:
    """Stand-ins for grader processes: the verdicts of ``NOW``."""

    def __init__(self):
        self.asked = []
        self.options = None

    def __call__(self, entries, options):
        self.options = options
        for entry in entries:
            assert entry.submission.files == {"doubling.py": entry.student.encode()}
            self.asked.append(entry.student)
            yield Graded(entry, NOW[entry.student])


def test_a_regrading_keeps_the_old_beside_the_new_and_a_second_one_finds_nothing_to_do(tmp_path, catalog):
    graders = Graders()
    with make_book(tmp_path, {"ada": WRONG, "bob": HALF}) as book:
        override(Results(book), "ada", "doubling", 1.5, "copied")
        tried = rerun(Results(book), catalog, RerunOptions(dry_run=True), grade=graders)
        assert (graders.options.seed, graders.options.timeout) == (7, 10.0)
        assert len(book.history("ada", "doubling")) == 1, "nothing is changed by saying it"
        done = rerun(Results(book), catalog, RerunOptions(), grade=graders)
        assert (done.changes, done.regraded, done.faults, done.kept) == (tried.changes, 2, 0, 0)
        assert [old.verdict.score for old in book.history("ada", "doubling")] == [0.0, 10.0]
        (found,) = Results(book).all("ada")
        assert (found.score, found.raw_score) == (1.5, 10.0)
        assert [change.overridden for change in done.changes] == [True]
        assert book.journal("bob") == [], "nothing changed"
        again = rerun(Results(book), catalog, RerunOptions(), grade=graders)
        assert (again.regraded, again.up_to_date) == (0, 2)
        assert len(book.history("ada", "doubling")) == 2
        everything = rerun(Results(book), catalog, RerunOptions(everything=True), grade=graders)
        assert (everything.regraded, everything.changes) == (2, ())
        assert len(book.history("ada", "doubling")) == 3


def test_what_a_fault_of_ours_left_is_graded_again_by_the_same_graders(tmp_path, catalog):
    version = grader_version(catalog.exercise("doubling"), catalog)
    with make_book(tmp_path, {}) as book:
        for student, found in (("ada", RIGHT), ("dan", BROKEN)):
            book.add(Result(key(student, version=version), found), {"doubling.py": student.encode()})
        graders = Graders()
        done = rerun(Results(book), catalog, RerunOptions(), grade=graders)
        assert graders.asked == ["dan"]
        assert (done.regraded, done.up_to_date) == (1, 1)
        assert {item.student: item.score for item in Results(book).all()} == {"ada": 10.0, "dan": 10.0}


def test_a_changed_score_is_in_the_log_and_a_fault_of_ours_takes_none_away(tmp_path, catalog):
    def broken(entries, _):
        yield from (Graded(entry, BROKEN) for entry in entries)

    with make_book(tmp_path, {"ada": HALF, "bob": BROKEN}) as book:
        done = rerun(Results(book), catalog, RerunOptions(), grade=broken)
        assert (done.faults, done.changes) == (2, ())
        said = BROKEN.error.message if BROKEN.error else ""
        assert [(one.student, one.message) for one in done.troubled] == [("ada", said), ("bob", said)]
        assert {item.student: item.score for item in Results(book).all()} == {"ada": 5.0, "bob": None}
        assert book.journal() == []
        rerun(Results(book), catalog, RerunOptions(reason="a wrong value"), grade=Graders())
        (noted,) = book.journal("ada")
        assert (noted.kind, noted.exercise, noted.reason) == ("rerun", "doubling", "a wrong value")
        assert [json.loads(text)["score"] for text in (noted.before, noted.after)] == [5.0, 10.0]


def test_a_warm_up_is_graded_again_like_any_exercise(tmp_path, monkeypatch):
    monkeypatch.delenv("COURSE_CONTENT")
    catalog = Catalog()
    name = catalog.warm_up_ids()[0]
    version = grader_version(catalog.exercise(name), catalog)
    with make_book(tmp_path, {}) as book:
        for student, theirs in (("ada", version), ("bob", "older")):
            book.add(Result(key(student, name, theirs), HALF), {"doubling.py": student.encode()})
        assert edited_since(Results(book), catalog) == [name]
        done = rerun(Results(book), catalog, RerunOptions(), grade=Graders())
        assert (done.regraded, done.up_to_date, done.kept) == (1, 1, 0)
        assert edited_since(Results(book), catalog) == []


def test_scores_by_hand_out_of_other_points_are_named_and_the_others_in_the_log(tmp_path, catalog):
    with make_book(tmp_path, {"ada": WRONG, "bob": WRONG}) as book:
        noted = [msgspec.structs.replace(one, max_points=8.0) for one in book.exercises()]
        book.set_exercises(noted)
        override(Results(book), "ada", "doubling", 1.5, "oral")
        done = rerun(Results(book), catalog, RerunOptions(), grade=Graders())
        assert done.rescaled == (
            "doubling is worth 10 points and was worth 8: scores by hand stay as they are, and are out of 10"
            " now: ada.",
        )
        assert rerun(Results(book), catalog, RerunOptions(everything=True), grade=Graders()).rescaled == ()


def test_what_was_not_handed_in_stays_as_it_is(tmp_path, catalog):
    with make_book(tmp_path, {}) as book:
        book.add(Result(key("cy"), REFUSED))
        book.add(Result(Key("ada", "gone", digest("ada"), "v", 7), RIGHT), {"doubling.py": b"ada"})
        done = rerun(Results(book), catalog, RerunOptions(), grade=Graders())
        assert (done.kept, done.regraded, done.changes) == (2, 0, ())
        assert done.gone == {"gone": 1}


def test_a_submission_that_is_not_what_was_handed_in_is_never_graded(tmp_path, catalog):
    with make_book(tmp_path, {}) as book:
        book.add(Result(key("ada"), WRONG), {"doubling.py": b"somebody else's"})
        with pytest.raises(IntegrityError, match="'ada'"):
            rerun(Results(book), catalog, RerunOptions(), grade=Graders())


def test_an_interrupted_regrading_goes_on_where_it_was(tmp_path, catalog):
    def dies(entries, options):
        yield next(Graders()(entries, options))
        raise KeyboardInterrupt

    graders = Graders()
    with make_book(tmp_path, {"ada": WRONG, "bob": HALF, "cy": HALF}) as book:
        with pytest.raises(KeyboardInterrupt):
            rerun(Results(book), catalog, RerunOptions(), grade=dies)
        rerun(Results(book), catalog, RerunOptions(), grade=graders)
        assert graders.asked == ["bob", "cy"]
        assert [len(book.history(name, "doubling")) for name in ("ada", "bob", "cy")] == [2, 2, 2]


def test_a_students_installation_can_neither_regrade_nor_pack_an_autograder(tmp_path, copied):
    shutil.rmtree(copied / "graders")
    with (
        make_book(tmp_path / "out", {"ada": WRONG}) as book,
        pytest.raises(MissingCapabilityError, match="hidden graders"),
    ):
        rerun(Results(book), Catalog(), RerunOptions())
    with pytest.raises(MissingCapabilityError, match="hidden graders"):
        write_autograder(tmp_path / "a.zip", Catalog(), (), seed=1, timeout=1.0, asked=False)
    assert not (tmp_path / "a.zip").exists()


def test_nothing_decides_a_score_but_what_the_version_of_the_graders_covers():
    """A change of a report must not regrade a class, and a change of a check's machinery must."""
    seen = subprocess.run(
        [
            sys.executable, "-c",
            "import sys, course.scoring.judging.session, course.scoring.kit;"
            "print(*{name.split('.')[1] for name in sys.modules if name.startswith('course.')})",
        ],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    covered = {"scoring", "isolation", "physics"}
    # Reads the exercise's files, which are covered themselves; names and types; words for a figure; how a
    # text is made harmless; and how a file is read.
    others = {"catalog", "errors", "ids", "figures", "printable", "strangers"}
    assert covered <= set(seen.stdout.split()) <= covered | others
