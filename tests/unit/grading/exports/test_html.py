"""The class page, the list of students and the pages to hand out."""

import base64
import dataclasses
import hashlib
import re
import statistics
import sys
from unittest.mock import Mock

import jinja2
import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from course.errors import MissingCapabilityError, UsageError
from course.grading.exports.formats import export
from course.grading.exports.grades import number, safe_cell
from course.grading.exports.html_report.pages import (
    _Compiled,
    class_page,
    duration,
    duration_bins,
    macro,
    mark_of,
    percent,
    score_bins,
    script,
    when,
)
from course.grading.exports.html_report.tally import MOST_ROWS, Tally
from course.grading.exports.selection import ExportOptions
from course.grading.gradebook.records import GradedExercise, Key, Override, Result
from course.grading.results.effective import Results
from course.grading.results.late import in_days
from course.grading.results.roster import Person, Roster
from course.grading.running.folder import open_results
from course.printable import one_line
from course.scoring.verdict import Problem, Status
from tests.unit.grading.exports.test_exports import SECRETS, everybody
from tests.unit.grading.made import (
    HALF,
    HOSTILE,
    REFUSED,
    RIGHT,
    WRONG,
    check,
    key,
    make_book,
    put,
    read_csv,
    verdict,
)
from tests.unit.grading.pages import Page, faults, read_page
from tests.unit.grading.test_results import POLICY

#: Names of one sort more: longer than any screen, from right to left, markup inside markup.
NAMES = [*HOSTILE, "y" * 10_000, "אבי כהן", "محمد", "</bdi><b>bold", '" onclick="x', "&lt;", "`code`"]
ALL = ExportOptions()


def quiz_verdict(right):
    """Five questions, so many of them right; ``expected`` is the key, which no page needs."""
    checks = [
        msgspec.structs.replace(
            check(f"question-{at}", Status.PASS if at < right else Status.FAIL, points=1.0),
            task="quiz",
            input={"seed": 3, "variant": "secret-variant"},
            expected="secret-key",
            actual="chosen-id",
        )
        for at in range(5)
    ]
    made = verdict(*checks, exercise="quiz")
    return msgspec.structs.replace(made, max_score=5.0, passed=right >= 4, isolation="")


@pytest.fixture(scope="module")
def out(tmp_path_factory):
    """A class with every name, every outcome, a quiz, overrides and people who are late."""
    folder = tmp_path_factory.mktemp("html")
    with everybody(folder, NAMES, wrong=WRONG) as book:
        book.set_exercises([GradedExercise("quiz", "Quiz", 5.0, 0.8, 1_000_000)])
        for at, name in enumerate(NAMES[:6]):
            book.add(Result(key(name, "quiz"), quiz_verdict(at)))
        book.add_override(Override("set", "halving", 1.5, "shown at the board"))
        book.add_override(Override("nothing handed in", "doubling", 3.0, "on paper"))
    with open_results(folder, writing=True):
        pass  # what lies beside a gradebook is written at the end of whatever changes it
    return folder


@pytest.fixture
def results(out):
    with open_results(out) as opened:
        yield opened


def places(out):
    """Name as a cell of the index -> file of the page."""
    return {row["student"]: row["page"] for row in read_csv(out / "students.csv")}


def test_templates_are_compiled_once_where_that_can_be_kept(tmp_path, monkeypatch):
    (tmp_path / "file").touch()
    for name, dont, kept in (("file", False, False), ("new", True, False), ("new", False, True)):
        monkeypatch.setattr(sys, "dont_write_bytecode", dont)
        compiled = []
        for text in ("one", "one", "two"):
            environment = jinja2.Environment(
                loader=jinja2.DictLoader({"page": text}),
                bytecode_cache=_Compiled(str(tmp_path / name), "%s.cache"),
            )
            monkeypatch.setattr(environment, "compile", Mock(wraps=environment.compile))
            assert environment.get_template("page").render() == text
            compiled += [source for (source, *_), _ in environment.compile.call_args_list]
        assert compiled == (["one", "two"] if kept else ["one", "one", "two"])


def test_every_page_is_sound_whatever_the_names(out):
    pages = {path: read_page(path) for path in [out / "report.html", *(out / "students").iterdir()]}
    pages[out / "students.html"] = read_page(out / "students.html")
    assert len(pages) == len(NAMES) + 5 + 2
    for path, page in pages.items():
        assert faults(page, scripted=path.parent == out) == [], path.name
        assert all(line.isprintable() for line in page.source.split("\n")), path.name
    assert {path.name for path in (out / "students").iterdir()} == {
        f"{at}.html" for at in range(1, len(NAMES) + 6)
    }


def test_a_score_by_hand_for_what_was_not_handed_in_needs_no_time(out, results):
    without = sum(bool(one.result.number) and one.submitted_at is None for one in results.all())
    said = " ".join((out / "report.html").read_text("utf-8").split())
    assert f"{without} have no trusted submission time" in said


def test_a_name_is_shown_as_text_on_the_page_of_its_own(out):
    found = places(out)
    assert len(found) == len(NAMES) + 5
    listed = read_page(out / "students.html").text
    for name in NAMES:
        shown = one_line(name if len(name) <= 120 else name[:120] + "…")
        page = read_page(out / found[safe_cell(name)])
        assert shown in page.pieces, ascii(name[:40])
        assert shown in listed
        assert len(page.source) < 30_000


def test_nobody_reads_another_name(out):
    found = places(out)
    names = ["late", "set", "broken", "wrong", "é漢字", "O'Neil", "אבי כהן", "nothing handed in"]
    for mine in names:
        page = read_page(out / found[mine])
        text_of = " ".join(page.pieces)
        marks = {"é漢字", "O'Neil", "אבי כהן", "Ada\\u202eevoL"} - {mine}
        assert not [name for name in marks if name in text_of], mine
        assert not [link for link in page.all("a") if not str(link["href"]).startswith("#")], mine


def test_what_is_handed_out_has_nothing_hidden(out):
    found = places(out)
    for name, path in found.items():
        if name == "wrong":
            continue  # fails a public check, whose values students see at home
        source = (out / path).read_text("utf-8")
        assert not [secret for secret in [*SECRETS, "secret-key", "secret-variant"] if secret in source], name
    assert SECRETS[0] in (out / found["wrong"]).read_text("utf-8")
    half = read_page(out / found[safe_cell("+1")]).text
    assert "It is not twice the number." in half
    assert "Add it to itself." in half
    assert "SQUARES" not in half, "a code is for instructors"
    assert "hidden check" in half
    broken = read_page(out / found["broken"]).text
    assert "ZeroDivisionError" not in broken
    assert "It will be graded again." in broken
    for name in ("report.html", "students.html"):
        assert not [secret for secret in SECRETS[:2] if secret in read_page(out / name).tables], name


def test_every_number_of_the_class_page_is_the_gradebooks(out, results):
    page = read_page(out / "report.html")
    everything = list(results.all())
    titles = {item.id: item.title for item in results.exercises()}
    rows = {row[0].split()[0]: row[1:] for row in page.tables["Results and scores"][1:]}
    for name, title in titles.items():
        mine = [item for item in everything if item.exercise == name]
        graded = [
            item for item in mine
            if item.score is not None and (item.verdict.state == "graded" or item.override is not None)
        ]  # fmt: skip
        scores = [item.score for item in graded if item.score is not None]
        passed = sum(item.passed for item in mine)
        assert rows[title] == [
            f"{len(graded)} of {len(mine)}",
            f"{passed} {passed / len(graded):.0%}".replace("%", " %"),
            f"{statistics.median(scores):.2f}".rstrip("0").rstrip(".")
            + f" mean {statistics.mean(scores):.2f}".rstrip("0").rstrip("."),
        ]
    facts = re.findall(r"<dt>(?:<a[^>]*>)?([^<]+)(?:</a>)?</dt><dd>(\d+)</dd>", page.source)
    ungraded = [item for item in everything if item.verdict.state == "ungradable" and item.override is None]
    assert dict(facts) == {
        "students": str(len(results.students())),
        "graded results": str(len(everything) - len(ungraded) - 1),
        "of them pass": str(sum(item.passed for item in everything)),
        "could not be graded": str(len(ungraded)),
        "faults of the grader": "1",
        "scores set by hand": "3",
        "handed in late": "1",
    }


def test_pass_rates_and_diagnoses_are_counted_per_student(out, results):
    page = read_page(out / "report.html")
    graded = [item.verdict for item in results.all(exercise="doubling") if item.verdict.state == "graded"]
    right = sum(item.checks[1].status is Status.PASS for item in graded)
    (row,) = [row for row in page.tables["Pass rate per check"] if "kept_back" in row[0]]
    share = f"{right / len(graded):.0%}".replace("%", " %")
    assert row[1] == f"{share} {right} of {len(graded)}; {len(graded) - right} failed"
    mistaken = sum(any(found.diagnosis == "SQUARES" for found in item.checks) for item in graded)
    (squares,) = [
        row for row in page.tables["Mistakes by the number of students who made them"] if "Doubling" in row[0]
    ]
    assert "Add it to itself." in squares[0].partition("Doubling")[0], "what is to be done stands first"
    assert squares[0].endswith("SQUARES")
    assert squares[1].startswith(f"{mistaken} of {len(graded)},")
    tasks = page.tables["Share of the points that the class earned, by task, lowest first"]
    points = sum(item.score for item in graded) / sum(item.max_score for item in graded)
    assert tasks[1][1].startswith(f"{points:.0%}".replace("%", " %"))
    assert len(tasks) == 2, "questions of the quiz are no tasks"
    questions = page.tables["Right answers per question"]
    assert [row[1].split(" % ")[1] for row in questions[1:]] == [
        "5 of 6; 1 wrong", "4 of 6; 2 wrong", "3 of 6; 3 wrong", "2 of 6; 4 wrong", "1 of 6; 5 wrong",
    ]  # fmt: skip


def test_the_histogram_counts_everybody_with_a_grade_once(out, results):
    drawings = [str(item.get("aria-label")) for item in read_page(out / "report.html").all("svg")]
    for name in ("doubling", "quiz"):
        scored = [
            item for item in results.all(exercise=name)
            if item.score is not None and (item.verdict.state == "graded" or item.override is not None)
        ]  # fmt: skip
        counts = [
            sum(int(count) for count in re.findall(r": (\d+)", drawing))
            for drawing in drawings
            if drawing.startswith(f"Scores of {len(scored)} students")
        ]
        assert counts == [len(scored)]


def test_the_list_of_students_has_the_scores_of_the_table(out):
    rows = read_page(out / "students.html").tables["Students and their scores"]
    assert rows[0] == ["Page", "Student", "Doubling, of 10", "Halving, of 2", "Quiz, of 5"]
    found = places(out)
    for line in read_csv(out / "grades.csv"):
        row = rows[int(re.findall(r"\d+", found[line["student"]])[0])]
        shown = row[{"doubling": 2, "halving": 3, "quiz": 4}[line["exercise"]]]
        assert shown.split()[0] == (line["score"] or "none"), line
    by_name = {row[1]: row for row in rows}
    assert by_name["late"][2] == "8 late"
    assert by_name["set"][2:] == ["8.25 by hand", "1.5 by hand", "–"]
    assert by_name["broken"][2] == "none fault of the grader"


def test_each_check_on_a_page_has_its_points_of_the_run(tmp_path):
    checks = (check("free", points=0.0), check("paid", hidden=True, points=2.0))
    with make_book(tmp_path, {"ada": verdict(*checks)}):
        pass
    with open_results(tmp_path, writing=True):
        pass
    words = " ".join(read_page(tmp_path / "students" / "1.html").pieces)
    assert "The title of free no points" in words
    assert "The title of paid 2 of 2 points, hidden check" in words


def test_a_page_has_the_score_that_counts_and_why(out):
    found = places(out)
    late = " ".join(read_page(out / found["late"]).pieces)
    assert "8 of 10 points : passed, 2 points off for lateness." in late
    assert "Handed in 2 d after the deadline; 2 points were taken off 10." in late
    by_hand = read_page(out / found["set"])
    words = " ".join(by_hand.pieces)
    assert [row[:2] for row in by_hand.tables["Scores"][1:]] == [
        ["Doubling", "8.25 of 10"],
        ["Halving", "1.5 of 2"],
    ]
    assert "The checks gave 5." in words
    assert 'said "=1+1", <b>then</b> left\nearly' in words
    assert "shown at the board" in words
    assert "on paper" in read_page(out / found["nothing handed in"]).text
    refused = read_page(out / found[safe_cell("-1")]).text
    assert "could not be graded" in refused
    assert "There is none." in refused


def test_a_function_that_is_not_written_is_one_finding_and_no_mistake(tmp_path):
    """What is hidden of it too; three hidden checks of which only the same is said are one as well."""
    raised = {"status": Status.ERROR, "input": None, "expected": None, "actual": None, "stdout": None}
    unwritten = {**raised, "diagnosis": "NOT_IMPLEMENTED", "message": "Not yet.", "help": "Write it."}
    ends = [(check(f"c{at}", Status.FAIL, hidden=at > 0), at) for at in range(3)]
    stub = verdict(*(msgspec.structs.replace(one, **unwritten) for one, _ in ends))
    raises = verdict(*(msgspec.structs.replace(one, **raised) for one, _ in ends))
    with make_book(tmp_path, {"stub": stub, "raises": raises}):
        pass
    with open_results(tmp_path, writing=True):
        pass
    index = places(tmp_path)
    page, other = ((tmp_path / index[name]).read_text("utf-8") for name in ("stub", "raises"))
    assert [page.count(words) for words in ("Not yet.", "3 checks", "0 of 15 points")] == [1, 1, 1]
    assert not [words for words in ("whose details", "raised an error") if words in page]
    assert other.count("whose details") == other.count("2 checks: The title of c1; The title of c2") == 1
    report = (tmp_path / "report.html").read_text("utf-8")
    assert report.count("1 raised an error, 1 not written") == 3
    assert [words in report for words in ("Write it.", "Add it to itself.")] == [False, True]


def test_overrides_late_and_who_could_not_be_graded_are_listed(out, results):
    page = read_page(out / "report.html")
    refused = [item for item in results.all() if item.verdict.error is not None and item.result.number]
    assert len(page.tables["One by one"]) == len(refused) + 1
    reasons = {row[0].split()[0]: row for row in page.tables["By reason"][1:]}
    assert reasons["check_failed"] == ["check_failed Doubling", "fault of the grader", "1"]
    assert reasons["no_file"][2] == str(len(refused) - 1)
    by_hand = page.tables["Scores that replace the graders'"]
    assert sorted(row[1] for row in by_hand[1:]) == [
        "1.5 of 2 checks: –", "3 of 10 checks: –", "8.25 of 10 checks: 5",
    ]  # fmt: skip
    assert page.tables["Late submissions, the latest first"][1:] == [["late Doubling", "2 d", "2", "8"]]
    graded = sum(item.verdict.isolation == "L3" for item in results.all())
    assert page.tables["Submissions by protection level"][1][:2] == ["L3", str(graded)]
    assert f"course grade rerun {out}" in page.text


def test_the_policy_lets_one_script_run_and_loads_nothing(out):
    digest_ = base64.b64encode(hashlib.sha256(script().encode()).digest()).decode()
    for name, scripted in (("report.html", True), ("students.html", True), ("students/1.html", False)):
        page = read_page(out / name)
        (policy,) = [
            item["content"]
            for item in page.all("meta")
            if item.get("http-equiv") == "Content-Security-Policy"
        ]
        assert str(policy).startswith("default-src 'none'; style-src 'unsafe-inline'; img-src data:")
        assert (f"script-src 'sha256-{digest_}'" in str(policy)) is scripted
        assert (f"<script>{script()}</script>" in page.source) is scripted
        assert not re.search(r"https?:|//[a-z]|url\(|@import", page.source.replace(script(), ""))


def test_a_second_export_leaves_no_page_of_somebody_else(tmp_path):
    with make_book(tmp_path, {f"student {at}": RIGHT for at in range(4)}) as book:
        export(Results(book), "html", tmp_path, None, ALL)
        mine = tmp_path / "students" / "77.html"
        mine.write_text("<p>not ours</p>")
        before = {path.name for path in (tmp_path / "students").iterdir()}
        results = Results(book)
        results.roster = Roster((Person("student 0"), Person("student 1")))
        partial = dataclasses.replace(ALL, partial=True)
        with pytest.raises(MissingCapabilityError):
            export(results, "html", tmp_path, None, ALL)
        written = export(results, "html", tmp_path, tmp_path, partial)
    assert before == {"1.html", "2.html", "3.html", "4.html", "77.html"}
    assert {path.name for path in (tmp_path / "students").iterdir()} == {"1.html", "2.html", "77.html"}
    assert (written.rows, written.unmatched) == (2, ["student 2", "student 3"])


def test_the_page_goes_where_it_is_told(tmp_path):
    with make_book(tmp_path / "out", {"ada": RIGHT}) as book:
        results = Results(book)
        results.roster = Roster((Person("ada", "Ada Lovelace", "ada@x.org", section="B"),))
        export(results, "html", tmp_path / "out", tmp_path / "web" / "spring.html", ALL)
        export(results, "html", tmp_path / "out", tmp_path / "folder", ALL)
    assert {path.name for path in (tmp_path / "web").iterdir()} == {
        "spring.html", "students.html", "students.csv", "students",
    }  # fmt: skip
    assert {"href": "spring.html"} in read_page(tmp_path / "web" / "students.html").all("a")
    assert (tmp_path / "folder" / "report.html").is_file()
    page = read_page(tmp_path / "web" / "students" / "1.html")
    said = [piece for piece in page.pieces if piece.strip()]
    assert said[said.index("Skip to the content") + 1] == "Ada Lovelace"
    row = read_page(tmp_path / "web" / "students.html").tables["Students and their scores"][1]
    assert row == ["1", "ada", "Ada Lovelace", "B", "10", "–"]


@pytest.mark.parametrize(
    ("target", "there"),
    [
        ("b.html", "students.html"), ("b.html", "students.csv"), ("b.html", "students/1.html"),
        ("", "report.html"), ("", "students.csv"), ("b.html", "an export to a.html"),
        ("gradescope", "gradescope/index.csv"), ("gradescope", "gradescope/00001.json"),
    ],
)  # fmt: skip
def test_nothing_is_replaced_that_no_export_to_this_page_made(tmp_path, target, there):
    web, name = tmp_path / "web", "gradescope" if target == "gradescope" else "html"
    with make_book(tmp_path / "out", {"ada": RIGHT}) as book:
        results = Results(book)
        if there.startswith("an"):
            export(results, "html", tmp_path / "out", web / "a.html", ALL)
        else:
            put(web / there, b"mine")
        before = {path: path.read_bytes() for path in web.rglob("*.*")}
        with pytest.raises(UsageError) as caught:
            export(results, name, tmp_path / "out", web / target, ALL)
        assert caught.value.code == "out_exists"
        assert (
            there.removeprefix("gradescope/") if there[:2] != "an" else "students.csv"
        ) in caught.value.message
        assert {path: path.read_bytes() for path in web.rglob("*.*")} == before
        for _ in range(2):
            export(results, name, tmp_path / "out", tmp_path / "new" / target, ALL)


def test_the_class_page_does_not_grow_with_the_class(tmp_path):
    """Lists stop; whoever is not listed is counted."""
    sizes = {}
    with make_book(tmp_path, {}) as book:
        book.set_meta(late_policy=POLICY)
        results = Results(book)
        for students in (MOST_ROWS, 10 * MOST_ROWS):
            tally = Tally(results.exercises())
            links = {}
            for at in range(students):
                name = f"student {at:05}"
                links[name] = f"students/{at + 1}.html"
                made = (REFUSED, HALF)[at % 2]
                found = results.of(
                    Result(Key(name, "doubling", "", "v1", 7), made, "2026-12-02T10:00:00Z", 1, 1)
                )
                by_hand = Override(name, "doubling", 5.0, "oral") if at % 4 == 1 else None
                tally.take([dataclasses.replace(found, late=60.0 * at if at % 2 else None, override=by_hand)])
            sizes[students] = len(class_page(results, tally, links, "students.html"))
            assert tally.troubled.count == students // 2
            assert tally.late.shown[0].student == f"student {students - 1:05}"
    assert sizes[10 * MOST_ROWS] < 2 * sizes[MOST_ROWS] < 500_000


def test_a_class_of_which_nothing_could_be_graded_has_a_page(tmp_path):
    problem = Problem("syntax_error", "line 1: `def f(:`", "Look `there`.")
    with make_book(tmp_path, {"ada": verdict(state="ungradable", error=problem)}) as book:
        export(Results(book), "html", tmp_path, None, ALL)
    page = read_page(tmp_path / "report.html")
    assert faults(page, scripted=True) == []
    assert "No submission could be graded." in page.text
    assert "def f(:" in page.pieces


def test_what_is_no_markup_becomes_none():
    hostile = 'a\u202eb\x1b<b title="&">'
    drawn = macro("charts", "bar_rows", [(hostile, 1, 2)], hostile)
    shown = "a\\u202eb\\x1b&lt;b title=&#34;&amp;&#34;&gt;"
    assert f"<figcaption>{shown}</figcaption>" in drawn
    assert f'aria-label="{shown}. {shown}: 1 of 2"' in drawn
    assert "<b" not in drawn
    said = macro("macros", "paragraph", "use `a<b` or `\nthen \u202e")
    assert said.strip() == '<p class="words">use <code>a&lt;b</code> or `\nthen \\u202e</p>'
    assert macro("macros", "paragraph", " \n") == ""
    assert number(None) == ""


# -- bars, shares and times: what is drawn is what was counted -----------------------------------------------


@given(
    st.lists(st.floats(0, 120) | st.integers(0, 100).map(float), max_size=60),
    st.sampled_from([2.0, 10.0, 100.0]),
)
def test_every_score_is_in_one_bar(scores, most):
    bins, each = score_bins(scores, most)
    assert sum(item.count for item in bins) == len(scores)
    assert len(bins) == (most + 1 if each else 10)


def test_whole_scores_of_few_points_have_a_bar_each():
    bins, each = score_bins([0, 3, 5, 5, 5], 5.0)
    assert each
    assert [(item.label, item.count) for item in bins] == [
        ("0", 1), ("1", 0), ("2", 0), ("3", 1), ("4", 0), ("5", 3),
    ]  # fmt: skip
    assert mark_of(0.8, 5.0, each=True) == 4, "the line stands left of the first score that passes"


def test_a_score_at_the_pass_mark_stands_right_of_its_line():
    bins, each = score_bins([69.9, 70.0, 100.0], 100.0)
    assert not each
    assert [item.count for item in bins] == [0, 0, 0, 0, 0, 0, 1, 1, 0, 1]
    assert mark_of(0.7, 100.0, each=False) == pytest.approx(7)


@given(st.lists(st.floats(0, 1e4), min_size=1, max_size=50))
def test_every_time_is_in_one_bar(seconds):
    bins = duration_bins(seconds)
    assert sum(item.count for item in bins) == len(seconds)
    assert bins[0].count
    assert bins[-1].count


def test_only_everything_is_a_hundred_percent():
    shares = [(0, 300), (1, 300), (150, 300), (299, 300), (300, 300), (0, 0)]
    assert [percent(*share) for share in shares] == [
        "0 %", "under 1 %", "50 %", "over 99 %", "100 %", "–",
    ]  # fmt: skip


def test_bars_are_as_high_as_their_counts():
    bins, _ = score_bins([5.0] * 30 + [95.0] * 10, 100.0)
    page = Page(macro("charts", "histogram", bins, "Scores", "%", last="100", mark=(7.0, "pass mark")))
    heights = [float(item["height"] or 0) for item in page.all("rect")]
    assert heights[0] == pytest.approx(3 * heights[9], rel=1e-3)
    assert set(heights[1:9]) == {0}
    assert page.all("svg")[0]["aria-label"] == "Scores. 0 to under 10 %: 30; 90 to 100 %: 10"
    assert page.faults == []


def test_no_bar_leaves_its_track():
    drawing = macro(
        "charts",
        "bar_rows",
        [("half", 5, 10), ("more", 15, 10), ("less", -1, 10), ("nothing", 0, 0)],
        "Points",
    )
    widths = [float(found) for found in re.findall(r'width="([\d.]+)" height="10" class="bar"', drawing)]
    assert widths == [180, 360, 0, 0]
    assert "15 of 10" in Page(drawing).pieces


def test_times_are_written_as_a_person_reads_them():
    assert [duration(value) for value in (0.0004, 0.0123, 0.9, 1.234, 75.0)] == [
        "0.4 ms", "12 ms", "900 ms", "1.23 s", "75 s",
    ]  # fmt: skip
    assert [in_days(value) for value in (1, 900, 900.5, 3_700, 86_400, 87_060, 90_100)] == [
        "1 min", "15 min", "16 min", "1 h 2 min", "1 d", "1 d 11 min", "1 d 1 h 2 min",
    ]  # fmt: skip
    assert when("2026-12-01T23:59:07Z") == "2026-12-01 23:59 UTC"
    assert when("") == ""
