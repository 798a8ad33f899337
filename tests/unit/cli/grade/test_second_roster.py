"""A later roster is merged into the stored one: what it does not say stays."""

import csv
import datetime as dt
import io
import shlex
import subprocess
import sys
from pathlib import Path

import msgspec
import pytest

from course.grading.gradebook.records import PlatformIdentity, SubmittedAt
from course.grading.results.effective import Results
from course.grading.results.merge import merged
from course.grading.results.roster import Person, Roster, read_roster
from course.grading.running import batch
from course.grading.running.folder import open_results
from tests.command_line import in_process
from tests.unit.cli.grade.test_grade_after import grades
from tests.unit.grading.made import HALF, RIGHT, digest, make_book
from tests.unit.grading.running.test_run import right
from tests.unit.grading.test_results import DAY, DUE, POLICY

FIRST = """student,name,email,extension_days
ada,Ada Lovelace,ada@x.org,
bob,Bob Byrne,bob@x.org,2
gus,Gus Petit,gus@x.org,
"""
CANVAS = """Student,ID,SIS User ID,SIS Login ID,Section,Doubling (4711)
    Points Possible,,,,,10
"Lovelace, Ada",101,S1,ada,A,
"Byrne, Bob",102,S2,bob,A,
"Petit, Gus",107,S7,gus,A,
"""


@pytest.fixture
def out(tmp_path):
    with make_book(tmp_path / "out", {"ada": RIGHT, "bob": RIGHT}) as book:
        at = DUE.timestamp() + 2 * DAY
        book.add_times([SubmittedAt("bob", "doubling", digest("bob"), "gradescope", at)])
    write(tmp_path, "first.csv", FIRST)
    write(tmp_path, "canvas.csv", CANVAS)
    write(tmp_path, "late.toml", POLICY[: POLICY.index("[[extension]]")])
    return tmp_path / "out"


def write(folder, name, text):
    (folder / name).parent.mkdir(parents=True, exist_ok=True)
    (folder / name).write_text(text, "utf-8")
    return folder / name


TO_CANVAS = (
    "grade", "export", "out", "--format", "canvas", "--exercise", "doubling",
    "--assignment", "doubling=4711", "--roster",
)  # fmt: skip


def test_a_second_roster_takes_nothing_away(course, out):
    set_up = ("grade", "late", "out", "--policy", "late.toml", "--roster", "first.csv")
    assert course(*set_up).code == 0
    before = grades(out / "grades.csv")
    assert before["bob"]["score"] == "10"
    ran = course(*TO_CANVAS, "canvas.csv")
    assert (ran.code, ran.err, ran.out) == (0, "", "Wrote out/canvas.csv.\n")
    after = grades(out / "grades.csv")
    kept = ("score", "name", "email")
    assert {name: [row[key] for key in kept] for name, row in after.items()} == {
        name: [row[key] for key in kept] for name, row in before.items()
    }
    assert after["gus"]["section"] == "A"
    line = '"Bob Byrne","102","S2","bob","A","10"'
    assert line in (out / "canvas.csv").read_text().splitlines()


def test_whose_score_a_roster_changes_is_said_before_it_is_written(course, out):
    assert course("grade", "late", "out", "--policy", "late.toml", "--roster", "first.csv").code == 0
    write(out.parent, "next.csv", "student,canvas_id,extension_days\nada,101,\nbob,102,0\n")
    told = (
        "With next.csv, 1 score changes:\n  bob doubling: 10 of 10 -> 8 of 10\n"
        "1 student is not in next.csv and leaves the roster: gus\n"
    )
    lines = course(
        "grade", "export", "out", "--format", "jsonl", "--roster", "next.csv", "--partial", "--json"
    )
    assert "With next.csv, a score changes: bob doubling: 10 of 10 -> 8 of 10" in lines.err
    assert "leaves the roster: gus" in lines.err
    ran = course(*TO_CANVAS, "next.csv", "-o", "a.csv")
    assert ran.code == 0
    assert ran.out.startswith(f"{told}Wrote a.csv.\nCanvas takes a score as points of its own")
    assert "bob doubling 10 -> bob doubling 8" in course("grade", "log", "out").out
    ran = course("grade", "export", "out", "--roster", "first.csv", "-o", "b.csv", "--json")
    assert (ran.json["moved"], ran.json["dropped"]) == (
        [{"student": "bob", "exercise": "doubling", "before": 8.0, "after": 10.0, "max_before": 10.0,
          "max_after": 10.0}], [],
    )  # fmt: skip


def test_late_and_a_resumed_run_say_the_same(course, out, monkeypatch):
    monkeypatch.setattr(batch, "grade_all", lambda entries, terms, graders=1: right(entries, terms))
    assert course("grade", "late", "out", "--policy", "late.toml", "--roster", "first.csv").code == 0
    write(out.parent, "next.csv", "student,extension_days\nada,\nbob,0\n")
    ran = course("grade", "late", "out", "--roster", "next.csv", "--dry-run")
    assert "1 student is not in next.csv and leaves the roster: gus" in ran.out
    assert "bob doubling: 10 of 10 -> 8 of 10" in ran.out
    ran = course("grade", "late", "out", "--roster", "next.csv", "--dry-run", "--json")
    assert ran.json["dropped"] == ["gus"]
    write(out.parent, "class/ada/doubling.py", "def double(x):\n    return x + x\n")
    run = ("grade", "run", "class", "--out", "out", "--resume", "--exercise", "doubling", "--roster")
    ran = course(*run, "next.csv")
    assert ("bob doubling: 10 of 10 -> 8 of 10" in ran.out, "leaves the roster: gus" in ran.out) == (
        True,
        True,
    ), ran.err
    with open_results(out) as results:
        assert results.person("ada").email == "ada@x.org"


def merge(tmp_path, first, second, downloads=None):
    with make_book(tmp_path / str(len(second)), {"ada": RIGHT, "bob": HALF}) as book:
        book.set_students(downloads or {})
        return merged(Results(book, first), read_roster(write(tmp_path, "second.csv", second)))


LOVELACE = Person("Ada Lovelace_7", "Ada Lovelace", "ada@x.org", moodle_key="7")
ADA = Person("ada", "Ada Lovelace", "ada@x.org", login="ada")


@pytest.mark.parametrize(
    ("first", "second", "people"),
    [
        ([ADA], "student,name,section\nada,ada,B\n", [msgspec.structs.replace(ADA, section="B")]),
        ([LOVELACE], "Identifier,Status,Grade\nParticipant 7,x,\n", [LOVELACE]),
        (
            [Person("x1", "Ada L", "a@x.org"), Person("x2", "Ada L", "b@x.org"), Person("x3", "C")],
            "student,name\ny1,Ada L\ny2,C\ny3,C\n",
            [Person("y1", "Ada L"), Person("y2", "C"), Person("y3", "C")],
        ),
        (
            [Person("ada", canvas_id="101"), Person("bob", canvas_id="102")],
            "student,canvas_id\nada,\nbob,101\n",
            [Person("ada"), Person("bob", canvas_id="101")],
        ),
    ],
    ids=[
        "a name is not replaced by an id", "an anonymous worksheet has no names",
        "who could be two rows inherits from neither", "an id that another row has now does not stay",
    ],
)  # fmt: skip
def test_a_row_keeps_what_is_its_own_and_no_more(tmp_path, first, second, people):
    found = merge(tmp_path, Roster(tuple(first)), second)
    assert found.roster.people == tuple(people)
    assert found.dropped == [one.student for one in first if one.student.startswith("x")]
    assert found.roster.columns.get("email", "") == ("email" if any(one.email for one in first) else "")


def test_a_policy_finds_a_downloads_student_by_the_name_in_the_first_roster(tmp_path):
    first = Roster((Person("ada_l", "Ada", canvas_id="101"),))
    downloads = {"ada": PlatformIdentity("canvas", "101", "x")}
    (person,) = merge(tmp_path, first, CANVAS.partition('"Byrne')[0], downloads).roster.people
    assert (person.student, person.login, person.section) == ("ada_l", "ada", "A")
    worksheet = Roster((Person("ada", "Ada", canvas_id="101"),))
    (person,) = merge(tmp_path, worksheet, "student,canvas_id\nada_l,101\n", downloads).roster.people
    assert (person.student, person.name) == ("ada_l", "Ada")


WORKSHEET = """Identifier,Full name,Email address,Status,Grade,Last modified (grade),Feedback comments
Participant 500,A. Lovelace,ada@x.org,x,,-,
Participant 501,Bob Byrne,bob2@x.org,x,,-,
"""


def test_a_worksheet_finds_plain_folders_by_address_or_name(course, out):
    assert course("grade", "late", "out", "--roster", "first.csv").code == 0
    write(out.parent, "sheet.csv", WORKSHEET)
    filled = ("grade", "export", "out", "--format", "moodle-worksheet", "--exercise", "doubling")
    assert course(*filled, "--roster", "sheet.csv", "-o", "back.csv").code == 0
    rows = (out.parent / "back.csv").read_text().splitlines()
    assert [row.split(",")[4] for row in rows] == ["Grade", "10", "10"]
    # The participant numbers are in no field of a user, by which Moodle's grade import looks.
    ran = course("grade", "export", "out", "--format", "moodle", "-o", "moodle.csv")
    assert '"500","A. Lovelace","ada@x.org","10"' in (out.parent / "moodle.csv").read_text("utf-8-sig")
    for words in ("participant numbers", "other people", "--format moodle-worksheet", "'Email address'"):
        assert words in " ".join(ran.out.split())


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("canvas", "first.csv has neither canvas_id nor sis_user_id, and Canvas needs one of them."),
        ("moodle", "first.csv has no moodle_key, and Moodle needs it."),
        ("moodle-worksheet", "first.csv has no moodle_key, and Moodle needs it."),
    ],
)
def test_a_roster_without_the_column_is_refused_for_that(course, out, name, says):
    words = ("grade", "export", "out", "--format", name, "--roster", "first.csv", "--json")
    error = course(*words).json["error"]
    assert (error["code"], error["message"]) == ("unmatched_students", f"{says} Nothing was written.")
    assert "worksheet" in error["help"] or "Canvas' gradebook export" in error["help"]


def test_scores_are_on_the_scale_of_the_gradebook_that_canvas_gave(course, out):
    """Canvas would rescale what it gets: its own file says how many points an assignment has there."""
    text = CANVAS.replace("Doubling (4711)", '"Doubling, first try (4711)"').replace(",,10\n", ",,5\n")
    write(out.parent, "canvas.csv", text)
    course(*TO_CANVAS, "canvas.csv").ends(0, "doubling has 10 points here and 5 in Canvas")
    head, possible, *rows = (out / "canvas.csv").read_text().splitlines()
    assert head.endswith('"Section","Doubling, first try (4711)"')
    assert possible.endswith('"5"')
    assert '"Lovelace, Ada","101","S1","ada","A","5"' in rows
    wrong = tuple(word.replace("4711", "9999") for word in TO_CANVAS)
    ran = course(*wrong, "canvas.csv", "-o", "wrong.csv")
    assert (ran.code, (out.parent / "wrong.csv").exists()) == (2, False)
    assert "has no assignment 9999" in ran.err
    assert "Doubling, first try (4711)" in ran.err


@pytest.mark.parametrize(
    ("points", "score", "told"),
    [
        ("5.00", "5", "5 in Canvas"), ("5,00", "5", "5 in Canvas"), ("10,00", "10", ""),
        ("", "10", "no points"), ("nan", "10", "no points"), ("0", "10", "no points"),
        ("-3", "10", "no points"),
    ],
)  # fmt: skip
def test_points_are_read_in_every_language_and_said_where_there_are_none(course, out, points, score, told):
    """Source: canvas-lms/lib/gradebook_exporter.rb, ``format_numbers``: two digits, in a user's language."""
    rows = list(csv.reader(CANVAS.replace(",10\n", ",POINTS\n").splitlines()))
    text = "\n".join(";".join(row) for row in rows).replace("POINTS", points)
    write(out.parent, "canvas.csv", text)
    ran = course(*TO_CANVAS, "canvas.csv")
    rows = list(csv.reader((out / "canvas.csv").read_text().splitlines()))
    assert (rows[1][-1], rows[2][-1], ran.code) == (score, score, 0)
    assert told in ran.out
    assert len(ran.out.splitlines()) == 1 + bool(told)


def test_whom_canvas_excuses_stays_excused(course, out):
    write(out.parent, "canvas.csv", CANVAS.replace(",bob,A,", ",bob,A,EX"))
    ran = course(*TO_CANVAS, "canvas.csv")
    assert '"bob","A","EX"' in (out / "canvas.csv").read_text(), "an empty cell takes the excuse away"
    assert "nothing graded here, stays so: bob doubling (EX)." in " ".join(ran.out.split())
    assert course(*TO_CANVAS, "canvas.csv", "--json").json["kept"] == ["bob doubling (EX)"]
    assert course(*TO_CANVAS, "canvas.csv", "--overwrite").code == 0
    assert '"bob","A","10"' in (out / "canvas.csv").read_text()


def test_a_score_that_canvas_has_is_no_zero_where_nothing_was_handed_in(course, out):
    write(out.parent, "canvas.csv", CANVAS.replace(",gus,A,", ",gus,A,8.50"))
    ran = course(*TO_CANVAS, "canvas.csv", "--missing", "zero", "--json")
    assert '"gus","A","8.50"' in (out / "canvas.csv").read_text()
    assert ran.json["kept"] == ["petitgus_107 doubling (8.50)"]
    assert course(*TO_CANVAS, "canvas.csv", "--missing", "zero", "--overwrite").code == 0
    assert '"gus","A","0"' in (out / "canvas.csv").read_text()
    write(out.parent, "canvas.csv", CANVAS.replace(",gus,A,", ",gus,A,-1.5"))
    assert course(*TO_CANVAS, "canvas.csv", "--missing", "zero").code == 0
    assert '"gus","A","-1.5"' in (out / "canvas.csv").read_text(), "points below zero are no formula"
    write(out.parent, "canvas.csv", CANVAS.replace(",gus,A,", ",gus,A,=1+1"))
    for more in ((), ("--missing", "zero")):
        course(*TO_CANVAS, "canvas.csv", *more).ends(0, "'=1+1' for petitgus_107 doubling begins like a")
        assert '"gus","A",""' in (out / "canvas.csv").read_text()


def test_what_canvas_has_and_we_have_not_is_written_back(course, out):
    write(out.parent, "canvas.csv", CANVAS.replace(",gus,A,", ',gus,A,"7,50"'))
    assert course(*TO_CANVAS, "canvas.csv", "--overwrite").code == 0
    assert '"gus","A","7,50"' in (out / "canvas.csv").read_text()
    for theirs, ours in (("-1.5", "-1.5"), ("=cmd|'/C calc'!A0", ""), ("N/A", "N/A")):
        write(out.parent, "canvas.csv", CANVAS.replace(",gus,A,", f',gus,A,"{theirs}"'))
        ran = course(*TO_CANVAS, "canvas.csv")
        assert ran.code == 0
        assert f'"gus","A","{ours}"' in (out / "canvas.csv").read_text()
        assert ("begins like a formula" in " ".join(ran.out.split())) == (not ours)
    assert course(*TO_CANVAS[:-1], "--partial").code == 0
    ran = course(*TO_CANVAS[:-1])
    assert "an empty cell takes away the score or the excuse (EX)" in " ".join(ran.out.split())


def test_another_assignment_of_moodle_s_is_refused_before_it_doubles_the_class(course, tmp_path, monkeypatch):
    monkeypatch.setattr(batch, "grade_all", lambda entries, terms, graders=1: right(entries, terms))
    for folder, number in (("first", 52001), ("second", 63007)):
        for at, name in enumerate(("Ada Lovelace", "Bob Byrne")):
            where = f"{folder}/{name}_{number + at}_assignsubmission_file_/doubling.py"
            write(tmp_path, where, "def double(x):\n    return x + x\n")
    run = ("--out", "out", "--exercise", "doubling")
    assert course("grade", "run", "first", *run).code == 0
    before = (tmp_path / "out" / "grades.csv").read_bytes()
    ran = course("grade", "run", "second", *run, "--resume")
    assert ran.code == 2
    assert "there Ada Lovelace_52001 has another number (Ada Lovelace_63007 here)" in ran.err
    assert (tmp_path / "out" / "grades.csv").read_bytes() == before
    assert course("grade", "run", "first", *run, "--resume").code == 0


def test_who_is_not_there_has_no_log(course, out):
    assert course("grade", "log", "out", "nobody").code == 5
    assert course("grade", "log", "out", "ada", "no-such").code == 5
    assert course("grade", "log", "out", "ada", "doubling").code == 0


def test_a_roster_from_a_spreadsheet_is_read(tmp_path):
    text = "Student\tName\tE-mail\nada\tAda Lovelace\tada@x.org\n"
    (tmp_path / "r.txt").write_bytes(text.replace("E-mail", "EMAIL").encode("utf-16"))
    (person,) = read_roster(tmp_path / "r.txt").people
    assert (person.student, person.name, person.email) == ("ada", "Ada Lovelace", "ada@x.org")


def test_a_time_names_a_student_as_a_score_by_hand_does(course, out):
    write(out.parent, "named.csv", "student,name\nada,Ada Lovelace\nbob,Bob Byrne\n")
    write(
        out.parent, "times.csv", "student,exercise,submitted_at\nAda Lovelace,doubling,2031-01-01T00:00:00Z\n"
    )
    assert course("grade", "late", "out", "--roster", "named.csv", "--policy", "late.toml").code == 0
    ran = course("grade", "late", "out", "--times", "times.csv", "--json")
    assert ran.json["unknown_names"] == []
    assert "ada" in {one["student"] for one in ran.json["late"]}


def test_a_worksheet_s_numbers_are_not_what_a_student_is_known_by(course, out):
    write(out.parent, "own.csv", "student,name,moodle_key\nada,Ada Lovelace,ada@uni.example\n")
    sheet = (
        "Identifier,Full name,Grade,Maximum Grade,Last modified (grade)\nParticipant 500,Ada Lovelace,,10,-\n"
    )
    write(out.parent, "sheet.csv", sheet)
    for kind, file in (("moodle", "own.csv"), ("moodle-worksheet", "sheet.csv"), ("moodle", None)):
        roster = ("--roster", file) if file else ()
        words = ("--format", kind, "--exercise", "doubling", "--partial", *roster)
        assert course("grade", "export", "out", *words).code == 0
    assert "ada@uni.example" in (out / "moodle.csv").read_text()
    assert ",10," in (out / "moodle-worksheet.csv").read_text()


def test_the_student_for_tests_stops_no_export(course, tmp_path):
    with make_book(tmp_path / "out", {"lovelaceada_101": RIGHT, "studenttest_999": RIGHT}):
        pass
    write(tmp_path, "canvas.csv", CANVAS + '"Student, Test",999,,x,A,\n')
    ran = course(*TO_CANVAS, "canvas.csv")
    assert ran.code == 0, ran.err
    assert "studenttest_999 is Canvas' student for tests and was left out." in ran.out.replace("\n", " ")
    assert "999" not in (tmp_path / "out" / "canvas.csv").read_text()
    write(tmp_path, "canvas.csv", CANVAS)
    assert course(*TO_CANVAS, "canvas.csv").code == 0


def test_an_export_goes_to_standard_output_or_a_pipe(out):
    base = [sys.executable, "-m", "course", "grade", "export", str(out)]
    there = in_process("grade", "export", out, "-o", "-").stdout
    rows = csv.DictReader(io.StringIO(there.removeprefix("\ufeff")))
    assert [row["student"] for row in rows] == ["ada", "bob"]
    piped = subprocess.run([*base, "-o", "/dev/stdout"], capture_output=True, timeout=60, check=True)
    assert piped.stdout.decode() == there
    shell = f"{shlex.join(base)} -o /dev/stdout | head -c 10; {shlex.join(base)} -o - | head -c 10"
    cut = subprocess.run(["sh", "-c", shell], capture_output=True, timeout=60, check=True)
    assert (len(cut.stdout), cut.stderr) == (20, b"")
    assert Path("/dev/stdout").is_symlink() or not Path("/dev/stdout").is_file()
    assert in_process("grade", "export", out, "-o", "-", "--json").returncode == 2


def test_a_roster_in_a_western_code_page_and_a_german_worksheet_are_read(course, out):
    (out.parent / "latin.csv").write_bytes("student,name\nada,Ada Müller\nbob,Bob\n".encode("latin-1"))
    assert course("grade", "export", "out", "--roster", "latin.csv").code == 0
    assert grades(out / "grades.csv")["ada"]["name"] == "Ada Müller"
    sheet = (
        'ID,"Vollständiger Name",E-Mail-Adresse,Status,Bewertung,Bestwertung,'
        '"Bewertung kann geändert werden","Zuletzt geändert (Abgabe)","Zuletzt geändert (Bewertung)",'
        '"Feedback als Kommentar"\n'
        'Teilnehmer/in101,Ada,ada@x.org,Abgegeben,,"20,00",Ja,-,-,\n'
        'Teilnehmer/in102,bob,bob@x.org,Abgegeben,,"20,00",Nein,-,-,\n'
    )
    write(out.parent, "german.csv", sheet)
    words = "grade export out --format moodle-worksheet --exercise doubling --roster german.csv"
    assert course(*words.split()).code == 0
    head, ada, bob = (out / "moodle-worksheet.csv").read_text("utf-8").splitlines()
    assert head.startswith("ID,Vollständiger Name")
    assert ',"20","20,00",' in ada or ',20,"20,00",' in ada
    assert ',,"20,00",Nein' in bob


def test_a_student_is_called_as_the_roster_calls_her(course, out):
    write(out.parent, "canvas.csv", CANVAS)
    assert course(*TO_CANVAS, "canvas.csv").code == 0
    for name in ("Lovelace, Ada", "ada lovelace", "101", "S1", "ada"):
        ran = course("grade", "explain", "out", name, "doubling")
        assert ran.out.startswith("ada (Lovelace, Ada), doubling"), (name, ran.err)
    set_by_hand = ("grade", "override", "out", "Byrne, Bob", "doubling", "--score", "9", "--reason", "oral")
    assert "bob doubling: 9 of 10 counts" in course(*set_by_hand).out
    assert "bob doubling: oral" in course("grade", "log", "out", "Byrne, Bob").out
    assert course("grade", "explain", "out", "Nobody", "doubling").code == 5


@pytest.mark.parametrize(
    "words",
    [
        "Thursday, {0.day} {0:%B} {0.year}, {0:%I}:{0:%M} {0:%p}",
        "Thursday, {0:%B} {0.day}, {0.year}, {0.hour}:{0:%M}",
    ],
)
def test_moodles_worksheet_says_when_work_was_handed_in(course, tmp_path, words):
    with make_book(tmp_path / "out", {"Ada_101": RIGHT, "Bob_102": RIGHT}):
        pass
    write(tmp_path, "late.toml", POLICY[: POLICY.index("[[extension]]")])
    at = DUE + dt.timedelta(days=1, hours=1)
    sheet = (
        'Identifier,"Full name","Email address",Status,Grade,"Last modified (submission)",'
        f'"Last modified (grade)"\nParticipant 101,Ada,a@x.org,Submitted,,"{words.format(at)}",-\n'
        "Participant 102,Bob,b@x.org,No,,-,-\n"
    )
    write(tmp_path, "sheet.csv", sheet)
    told = ("grade", "late", "out", "--times", "sheet.csv", "--exercise", "doubling")
    assert "no deadline for doubling" in course(*told).err
    ran = course(*told, "--policy", "late.toml")
    assert "Ada_101 doubling: 1 d 1 h late" in ran.out, ran
    assert "1 has no trusted submission time; it counts as on time." in ran.out
    # Over a Sunday on which the clock may change, Moodle's words are an hour too vague for a penalty.
    write(tmp_path, "march.toml", POLICY[: POLICY.index("[[extension]]")].replace("2026-12-01", "2027-03-27"))
    for day, hour, unsure in ((29, 0, True), (29, 1, False), (28, 0, True), (27, 0, False)):
        late = dt.datetime(2027, 3, day, hour, 30)
        write(tmp_path, "sheet.csv", sheet.replace(words.format(at), words.format(late)))
        ran = course(*told, "--policy", "march.toml")
        assert (ran.code, "points of Ada_101" in ran.err) == (0, unsure), (day, hour, ran.err)
    write(tmp_path, "sheet.csv", sheet.replace(words.format(at), "gestern"))
    ran = course(*told)
    assert (ran.code, "'gestern' is not a time" in ran.err) == (2, True)


SHEET = (
    'Identifier,"Full name","Email address",Status,Grade,"Maximum Grade","Last modified (submission)",'
    '"Last modified (grade)"\n'
)


def handed_in(number, name, status="Submitted"):
    at = DUE + dt.timedelta(days=1, hours=1)
    return f'Participant {number},{name},x@y.org,"{status}",,10,"{at:%A, %d %B %Y, %H:%M}",-\n'


def test_a_number_of_moodles_beats_a_namesake_and_rows_that_fit_nobody_are_named(course, tmp_path):
    who = {"Kim_101": "101", "Kim_102": "102"}
    with make_book(tmp_path / "out", dict.fromkeys(who, RIGHT)) as book:
        book.set_students({name: PlatformIdentity("moodle", one, "Kim") for name, one in who.items()})
    write(tmp_path, "late.toml", POLICY[: POLICY.index("[[extension]]")])
    write(tmp_path, "sheet.csv", SHEET + handed_in(101, "Kim") + handed_in(103, "Lou"))
    times = ("--times", "sheet.csv", "--exercise", "doubling", "--policy", "late.toml")
    ran = course("grade", "late", "out", *times)
    assert "Kim_101 doubling: 1 d 1 h late" in ran.out
    assert "The gradebook has no one student for the row of Lou_103 in sheet.csv." in ran.err
    write(tmp_path, "sheet.csv", SHEET + handed_in(101, "Kim"))
    export = ("export", "out", "--format", "moodle-worksheet", "--roster", "sheet.csv")
    told = course("grade", *export).err
    assert "1 student. In one row with 'Kim_101': 'Kim_102'." in told
    assert "is one student in a new run (another --out)" in " ".join(told.split())
    assert course("grade", *export, "--partial", "-o", "sheet-filled.csv").code == 0
    filled = csv.DictReader((tmp_path / "sheet-filled.csv").read_text("utf-8").splitlines())
    assert [row["Grade"] for row in filled] == ["8"], "the row of the number was not hers"


def test_who_is_late_and_has_more_time_in_moodle_is_named_until_it_is_given_here(course, tmp_path):
    with make_book(tmp_path / "out", {"Ada_101": RIGHT, "Bob_102": RIGHT}):
        pass
    policy = POLICY[: POLICY.index("[[extension]]")]
    write(tmp_path, "late.toml", policy)
    until = "Zur Bewertung abgegeben - Verlängerung bis: Donnerstag, 3. Dezember 2026, 23:59"
    write(tmp_path, "sheet.csv", SHEET + handed_in(101, "Ada", until) + handed_in(102, "Bob"))
    times = ("--times", "sheet.csv", "--exercise", "doubling", "--policy", "late.toml")
    assert "By sheet.csv, Moodle gave Ada_101 more time." in " ".join(
        course("grade", "late", "out", *times).err.split()
    )
    write(tmp_path, "late.toml", policy + '[[extension]]\nstudent = "Ada_101"\ndays = 3\n')
    ran = course("grade", "late", "out", *times)
    assert (ran.code, ran.err, "Bob_102 doubling: 1 d 1 h late" in ran.out) == (0, "", True)


def test_an_hour_of_summer_time_that_costs_points_of_an_extension_is_named(course, tmp_path):
    with make_book(tmp_path / "out", {"Ada_101": RIGHT}):
        pass
    named = []
    for due, days in (("2026-10-24", 1), ("2026-10-27", 1), ("2026-10-25", 0)):
        write(
            tmp_path,
            "late.toml",
            f'format_version = 1\npercent_per_day = 10\n[[deadline]]\nexercise = "*"\n'
            f'due = {due}T23:59:00+02:00\n[[extension]]\nstudent = "Ada_101"\ndays = {days}\n',
        )
        at = dt.datetime.fromisoformat(f"{due}T23:30:00+01:00") + dt.timedelta(days=min(days, 1))
        write(tmp_path, "times.csv", f"student,exercise,submitted_at\nAda_101,doubling,{at.isoformat()}\n")
        ran = course("grade", "late", "out", "--policy", "late.toml", "--times", "times.csv")
        named.append("points of Ada_101: with `zone =" in " ".join(ran.err.split()))
    assert named == [True, False, False]


def test_a_german_worksheet_is_told_of_by_its_own_headings(course, tmp_path):
    headings = ["ID", "Vollständiger Name", "Bewertung", "Zuletzt geändert (Bewertung)"]
    with make_book(tmp_path / "out", {"Ada_101": RIGHT, "Bob_102": RIGHT}):
        pass
    export = ("grade", "export", "out", "--format", "moodle-worksheet", "--roster", "sheet.csv")
    write(tmp_path, "sheet.csv", ",".join(headings) + "\nTeilnehmer/in 101,Ada,,-\n")
    told = " ".join(course(*export).err.split())
    assert f"sheet.csv has the columns {', '.join(headings)}." in told
    assert "was looked for in ID, Vollständiger Name; it has" in told
    assert "Full name" not in told
    write(
        tmp_path, "sheet.csv", ",".join(headings[:3]) + "\nTeilnehmer/in 101,Ada,\nTeilnehmer/in 102,Bob,\n"
    )
    told = " ".join(course(*export).err.split())
    assert "it has no column 'Zuletzt geändert (Bewertung)', without which Moodle" in told


@pytest.mark.parametrize(
    ("day", "days", "handed_in", "costs"),
    [
        ("2026-10-24T23:59:00+02:00", 2, "2026-10-26T23:30:00+01:00", (0, 1)),  # two days and an hour
        ("2026-10-24T23:59:00+02:00", 0, "2026-10-25T23:30:00+01:00", (1, 2)),
        ("2026-10-24T23:59:00+02:00", 0, "2026-10-26T00:30:00+01:00", (2, 2)),
        ("2027-03-27T23:59:00+01:00", 2, "2027-03-30T00:30:00+02:00", (1, 0)),  # two days less an hour
        ("2027-03-27T23:59:00+01:00", 0, "2027-03-29T00:30:00+02:00", (2, 1)),
        ("2026-10-25T02:30:00+02:00", 0, "2026-10-25T02:10:00+01:00", (1, 1)),  # the hour that there is twice
    ],
)
def test_with_a_zone_a_day_ends_at_the_same_time_of_day(course, tmp_path, day, days, handed_in, costs):
    with make_book(tmp_path / "out", {"Ada_101": RIGHT}):
        pass
    write(tmp_path, "times.csv", f"student,exercise,submitted_at\nAda_101,doubling,{handed_in}\n")
    for zone, cost in zip(("Europe/Berlin", ""), costs, strict=True):
        write(
            tmp_path,
            "late.toml",
            f'format_version = 1\npoints_per_day = 1\nzone = "{zone}"\n[[deadline]]\nexercise = "*"\n'
            f'due = {day}\n[[extension]]\nstudent = "Ada_101"\ndays = {days}\n',
        )
        told = course("grade", "late", "out", "--policy", "late.toml", "--times", "times.csv", "--json")
        assert sum(one["penalty"] for one in told.json["late"]) == cost
        assert ("If the clock changed" in told.err) == (cost != costs[0])


def test_a_zone_that_is_not_known_is_refused_by_its_line(course, tmp_path):
    with make_book(tmp_path / "out", {"Ada_101": RIGHT}):
        pass
    for zone in ("Europe/Nowhere", "../etc", "Europe"):
        write(tmp_path, "late.toml", f'zone = "{zone}"\n{POLICY}')
        error = course("grade", "late", "out", "--policy", "late.toml", "--json").json["error"]
        assert error["code"] == "invalid_policy"
        assert error["message"] == f"late.toml:1: {zone!r} is no time zone that is known here."
