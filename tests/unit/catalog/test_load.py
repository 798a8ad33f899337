"""Reading course files, where they are found, and what is said when one is wrong."""

import shutil
from pathlib import Path

import pytest

from course.catalog import locate
from course.catalog.load import Catalog
from course.catalog.models import Task
from course.errors import ContentError, InternalError, NotFoundError, UsageError

MINI = Path(__file__).parents[2] / "fixtures" / "mini_course"
EXERCISE = "exercises/doubling/exercise.toml"
LESSON = "lessons/half-as-much.md"
SYLLABUS = "lessons/syllabus.toml"
TITLE_AND_POINTS = 'title = "Twice a number"\npoints = 4\n'
YOURS = "[task.yours]\n{}\n[task.fits]"
VERSION = 'version = "0.1.0"'


@pytest.fixture
def mini(tmp_path, monkeypatch):
    """The folder of a private copy of the miniature course, in use as the course."""
    folder = shutil.copytree(MINI, tmp_path / "mini")
    monkeypatch.setenv("COURSE_CONTENT", str(folder))
    return folder


@pytest.fixture
def catalog(mini):
    return Catalog()


def edit(path, old, new):
    """Replace the first ``old`` in a file; it must be there."""
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), encoding="utf-8")


def read_everything(catalog):
    catalog.lessons()
    catalog.exercises()


def refused(mini, file):
    """The error that reading the broken course ends with; it must be about this file."""
    with pytest.raises(ContentError) as caught:
        read_everything(Catalog())
    assert caught.value.file == mini.resolve() / file
    assert caught.value.help
    return caught.value


def test_a_course_without_a_version_has_the_packages(mini):
    from course import __version__

    edit(mini / SYLLABUS, 'version = "0.1.0"\n', "")
    assert Catalog().version == __version__


def test_lessons_come_in_the_order_of_the_syllabus(catalog, mini):
    assert [lesson.id for lesson in catalog.lessons()] == ["twice-as-much", "half-as-much"]
    assert catalog.lesson("half-as-much").before == ("twice-as-much",)
    assert Path(catalog.lesson("half-as-much").path) == mini.resolve() / LESSON


def test_exercises_come_in_their_order(mini):
    edit(mini / EXERCISE, "order = 1", "order = 9")
    assert [exercise.id for exercise in Catalog().exercises()] == ["halving", "doubling"]


def test_listing_ids_opens_nothing_but_the_syllabus(mini, monkeypatch):
    opened = []
    real = Path.read_bytes
    monkeypatch.setattr(Path, "read_bytes", lambda self: opened.append(self.name) or real(self))
    catalog = Catalog()
    assert catalog.exercise_ids() == ("doubling", "halving")
    assert opened == []
    assert catalog.lesson_ids() == ("twice-as-much", "half-as-much")
    assert opened == ["syllabus.toml"]


def test_a_file_is_read_once(catalog, monkeypatch):
    read_everything(catalog)
    monkeypatch.setattr(Path, "read_bytes", lambda self: pytest.fail(f"{self} was read again"))
    read_everything(catalog)


@pytest.mark.parametrize(
    ("kind", "wanted", "advice"),
    [
        ("exercise", "doublng", "Did you mean doubling?"),
        ("exercise", "halv", "Did you mean halving?"),
        ("exercise", "../doubling", "Did you mean doubling?"),
        ("exercise", "Zeppelin", "`course exercises` lists what there is."),
        ("lesson", "twice", "Did you mean twice-as-much?"),
    ],
)
def test_an_unknown_id_is_answered_with_the_nearest(catalog, kind, wanted, advice):
    with pytest.raises(NotFoundError) as caught:
        getattr(catalog, kind)(wanted)
    assert caught.value.code == f"{kind}_not_found"
    assert caught.value.help == advice


@pytest.mark.parametrize(
    ("file", "old", "new", "line", "problem", "fix"),
    [
        (EXERCISE, "summary =", "sumary =", 7, "unknown key `sumary`", "Did you mean summary?"),
        (EXERCISE, "summary =", "zzz = 1\nsummary =", 7, "unknown key `zzz`", "Known keys: "),
        (EXERCISE, "order = 1", 'folder = "/"\norder = 1', 6, "unknown key `folder`", "Did you mean order"),
        (EXERCISE, "order = 1\n", "", 1, "lacks the key `order`", "Add a line `order = ...`."),
        (EXERCISE, "order = 1", 'order = "1"', 6, "`order` must be a whole number", "Write a whole number."),
        (EXERCISE, "points = 6", 'points = "6"', 28, "`task[2].points` must be a number", "Write a number."),
        (EXERCISE, TITLE_AND_POINTS, "", 11, "the keys `title`, `points`.", "`points ="),
        (EXERCISE, "points = 4\n", "", 11, "`task[1]` lacks the key `points`", "points = ..."),
        (EXERCISE, "points = 4", "point = 4", 14, "unknown key `point`", "Did you mean points or hints?"),
        (EXERCISE, "points = 4", "points = 0", 14, "above 0", "public and hidden"),
        (EXERCISE, "points = 4", "points = nan", 14, "above 0", "public and hidden"),
        (EXERCISE, "points = 4", "points = inf", 14, "above 0", "public and hidden"),
        (EXERCISE, 'id = "doublings"', 'id = "double"', 26, "listed twice", "rename"),
        (EXERCISE, 'id = "doublings"', 'id = "a b"', 26, "not a Python name", "name of the function"),
        (EXERCISE, "order = 1", "order = 1\npass_mark = 70", 7, "`pass_mark`", "0.70 for 70 %"),
        (EXERCISE, "order = 1", "order = 1\npass_mark = 0", 7, "`pass_mark`", "0.70 for 70 %"),
        (EXERCISE, "order = 1", "order = 1\npass_mark = nan", 7, "`pass_mark`", "0.70 for 70 %"),
        (EXERCISE, "order = 1", "order = 1\ntime = 9", 7, "`time`", "how many times as long"),
        (EXERCISE, "order = 1", "order = 1\ntime = nan", 7, "`time`", "how many times as long"),
        (EXERCISE, "order = 1", "order = 0", 6, "`order` must be 1 or more", "from 1"),
        (EXERCISE, '"doubling.py"', '"../doubling.py"', 4, "not a plain Python file name", "underscores"),
        (EXERCISE, '"doubling.py"', '"doubling.txt"', 4, "not a plain Python file name", "underscores"),
        (EXERCISE, '"doubling.py"', '"checks.py"', 4, "another role", "another name"),
        (EXERCISE, 'id = "doubling"', 'id = "tripling"', 2, "the folder is called doubling", "rename"),
        (EXERCISE, 'title = "Doubling"', 'title = " "', 3, "`title` is empty", "Fill it in."),
        (EXERCISE, '"twice-as-much"', '"Twice"', 5, "not a valid lesson id", "hyphens"),
        (EXERCISE, "order = 1", 'order = 1\nimports = ["numpy.fft"]', 7, "not a top-level package", "alone"),
        (EXERCISE, "order = 1", 'order = 1\nimports = ["math"]', 7, "is part of Python", "Take it out."),
        (EXERCISE, "hidden_points = 5", "hidden_points = 11", 9, "between 0 and the sum", "Add up"),
        (EXERCISE, "hidden_checks = 2", "hidden_checks = -1", 8, "negative", "Count"),
        (EXERCISE, "format_version = 1", "format_version = 2", 1, "knows formats up to 1", "newer version"),
        (EXERCISE, "format_version = 1", 'format_version = "1"', 1, "whole number", "format_version = 1"),
        (EXERCISE, "format_version = 1\n", "", 1, "declares no format_version", "at the top"),
        (EXERCISE, "order = 1", "order = ", 6, "not valid TOML", "quotes"),
        (EXERCISE, "order = 1", "order = 1\norder = 2", 7, "stands in the file twice", "Keep one"),
        (EXERCISE, '"Return x + x."', '""', 19, "`hints` is empty", "Fill it in."),
        (EXERCISE, "[task.fits]", YOURS.format('4 = ["It is {got}."]'), 23, "no hint number 4", "1 to 3"),
        (EXERCISE, "[task.fits]", YOURS.format('2 = ["It is 4."]'), 23, "has no field: 'It is 4.'", "{got}"),
        (EXERCISE, '"Return x + x."', "3", 19, "`task[1].hints[3]` must be text in quotes", "Write text"),
        (LESSON, 'id = "half-as-much"', 'id = "half"', 3, "the file is called half-as-much.md", "rename"),
        (LESSON, "minutes = 2", "minutes = 0", 5, "more than 0", "how long"),
        (LESSON, '["Halve a number."]', "[]", 7, "`objectives` is empty", "one line each"),
        (LESSON, '["halving"]', '["Halving!"]', 9, "not a valid exercise id", "hyphens"),
        (LESSON, "title =", "titel =", 4, "unknown key `titel`", "Did you mean title?"),
        (LESSON, "+++", "", 1, "+++", "+++"),
        (SYLLABUS, 'id = "mini"', 'id = "Mini"', 2, "lower-case", "physics-sim"),
        (SYLLABUS, ', "half-as-much"', ', "twice-as-much"', 5, "listed twice", "Remove"),
        (SYLLABUS, VERSION, 'split = { half-as-much = "no" }', 4, "no is not in `lessons`", "listed there"),
    ],
)
def test_what_is_wrong_is_named_with_line_and_fix(mini, file, old, new, line, problem, fix):
    edit(mini / file, old, new)
    error = refused(mini, file)
    assert problem in error.problem
    assert fix in error.help
    assert error.line == line


def test_a_lesson_without_a_file_is_named(mini):
    (mini / LESSON).unlink()
    assert "missing" in refused(mini, LESSON).problem


def test_a_folder_in_a_files_place_is_named(mini):
    (mini / SYLLABUS).unlink()
    (mini / SYLLABUS).mkdir()
    assert "cannot be read" in refused(mini, SYLLABUS).problem


@pytest.mark.parametrize(
    ("data", "line", "problem"),
    [
        (b'format_version = 1\nid = "caf\xe9"\n', 2, "not UTF-8"),
        (b"\xef\xbb\xbfformat_version = 1\n", 1, "byte order mark"),
        (b"f\x00ormat_version = 1\n", 1, "not valid TOML"),
        ("format_version = 1\n".encode("utf-16"), 1, "not UTF-8"),
    ],
)
def test_an_odd_encoding_is_named(mini, data, line, problem):
    (mini / EXERCISE).write_bytes(data)
    error = refused(mini, EXERCISE)
    assert problem in error.problem
    assert error.line == line


def test_windows_line_ends_are_read(mini):
    for file in (EXERCISE, LESSON):
        path = mini / file
        path.write_bytes(path.read_bytes().replace(b"\n", b"\r\n"))
    read_everything(Catalog())


def test_a_folder_without_an_exercise_is_not_one(mini):
    (mini / "exercises" / "__pycache__").mkdir()
    assert Catalog().exercise_ids() == ("doubling", "halving")


def _package(root):
    (root / "course" / "lessons").mkdir(parents=True)
    return root / "course"


def test_an_unpacked_source_archive_is_a_students(tmp_path):
    package = _package(tmp_path)
    (tmp_path / "pyproject.toml").touch()
    (tmp_path / "exercises").mkdir()
    found = locate._installed(package)
    assert not found.is_checkout
    assert found.solutions is None


def test_a_wheel_reads_the_content_inside_the_package(tmp_path):
    package = _package(tmp_path)
    (package / "content" / "exercises").mkdir(parents=True)
    # What another package has put beside it is not ours.
    (tmp_path / "exercises").mkdir()
    (tmp_path / "solutions").mkdir()
    (tmp_path / "pyproject.toml").touch()
    found = locate._installed(package)
    assert found.exercises == package / "content" / "exercises"
    assert found.quiz == package / "content" / "quiz"
    assert found.solutions is None
    assert found.graders is None


def test_an_installation_without_content_says_so(tmp_path):
    with pytest.raises(InternalError, match="exercises are missing"):
        locate._installed(_package(tmp_path))


@pytest.mark.parametrize("missing", ["exercises", "lessons"])
def test_a_selected_folder_that_is_no_course_is_refused(mini, missing):
    (mini / missing).rename(mini / "gone")
    with pytest.raises(UsageError, match="holds no course") as caught:
        locate.content()
    assert caught.value.code == "no_such_content"


TASK = Task(
    id="throw",
    title="Throw",
    points=1.0,
    hints=("Look up.", "Count.", "Square it."),
    fits={"2": ("ONE_SHORT",), "3": ("NOT_SQUARED",)},
    yours={
        "any": ("It is {got}.",),
        "3": ("At t = {t s} it is {got}, {ratio} times as far.", "It is {got}, not {expected}."),
    },
)
FAR = {"t s": "2", "got": "4", "expected": "8", "ratio": "0.5"}
NEAR = {"got": "3", "expected": "9"}


@pytest.mark.parametrize(
    ("index", "failed", "words"),
    [
        (0, [("", FAR)], "Look up. It is 4."),
        (1, [("", {}), ("", NEAR)], "Count. It is 3."),
        (1, [("", FAR), ("ONE_SHORT", NEAR)], "Count. It is 3."),
        (2, [("NOT_SQUARED", FAR)], "Square it. At t = 2 it is 4, 0.5 times as far."),
        (2, [("NOT_SQUARED", NEAR)], "Square it. It is 3, not 9."),
        (2, [("NOT_SQUARED", {"got": "3"})], "Square it."),
        (2, [], "Square it."),
    ],
)
def test_a_hint_says_the_first_sentence_whose_fields_the_failed_check_has(index, failed, words):
    assert TASK.said(index, failed) == words


def test_braces_in_a_students_value_stay_as_they_are():
    assert TASK.said(0, [("", {"got": "{expected}"})]) == "Look up. It is {expected}."


@pytest.mark.parametrize(
    ("diagnoses", "given", "following"),
    [
        ((), (), 0),
        (("NOT_SQUARED",), (), 2),
        (("NOT_SQUARED",), (2,), 0),
        (("OTHER",), (0, 1), 2),
        ((), (0, 1, 2), None),
    ],
)
def test_the_hint_that_fits_comes_before_the_mildest(diagnoses, given, following):
    assert TASK.following(diagnoses, given) == following
