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
from course.grading.running.folder import open_results
from tests.command_line import in_process
from tests.unit.cli.grade.conftest import RUN, STRICT, grades, write, write_policy, write_times
from tests.unit.grading.made import HALF, RIGHT, digest, make_book
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
    write(tmp_path, "late.toml", STRICT)
    return tmp_path / "out"


FOR_CANVAS = "grade export out --format canvas --exercise doubling --assignment doubling=4711"
TO_CANVAS = f"{FOR_CANVAS} --roster canvas.csv"


def canvas_has(out, student, cell):
    """What stands already in a student's cell."""
    write(out.parent, "canvas.csv", CANVAS.replace(f",{student},A,", f",{student},A,{cell}"))


def for_canvas(out):
    """What was written for it."""
    return (out / "canvas.csv").read_text()


def test_a_second_roster_takes_nothing_away(course, out):
    course("grade late out --policy late.toml --roster first.csv").ends(0)
    before = grades(out / "grades.csv")
    assert before["bob"]["score"] == "10"
    ran = course(TO_CANVAS)
    assert (ran.code, ran.err, ran.out) == (0, "", "Wrote out/canvas.csv.\n")
    after = grades(out / "grades.csv")
    for key in ("score", "name", "email"):
        assert {name: row[key] for name, row in after.items()} == {
            name: row[key] for name, row in before.items()
        }
    assert after["gus"]["section"] == "A"
    assert '"Bob Byrne","102","S2","bob","A","10"' in for_canvas(out).splitlines()


def test_whose_score_a_roster_changes_is_said_before_it_is_written(course, out):
    assert course("grade late out --policy late.toml --roster first.csv").code == 0
    write(out.parent, "next.csv", "student,canvas_id,extension_days\nada,101,\nbob,102,0\n")
    told = (
        "With next.csv, 1 score changes:\n  bob doubling: 10 of 10 -> 8 of 10\n"
        "1 student is not in next.csv and leaves the roster: gus\n"
    )
    course("grade export out --format jsonl --roster next.csv --partial --json").warns(
        "With next.csv, a score changes: bob doubling: 10 of 10 -> 8 of 10", "leaves the roster: gus"
    )
    ran = course(f"{FOR_CANVAS} --roster next.csv -o a.csv").ends(0)
    assert ran.out.startswith(f"{told}Wrote a.csv.\nCanvas takes a score as points of its own")
    course("grade log out").says("bob doubling 10 -> bob doubling 8")
    ran = course("grade export out --roster first.csv -o b.csv --json")
    assert (ran.json["moved"], ran.json["dropped"]) == (
        [{"student": "bob", "exercise": "doubling", "before": 8.0, "after": 10.0, "max_before": 10.0,
          "max_after": 10.0}], [],
    )  # fmt: skip


@pytest.mark.usefixtures("ungraded")
def test_late_and_a_resumed_run_say_the_same(course, out):
    assert course("grade late out --policy late.toml --roster first.csv").code == 0
    write(out.parent, "next.csv", "student,extension_days\nada,\nbob,0\n")
    course("grade late out --roster next.csv --dry-run").says(
        "1 student is not in next.csv and leaves the roster: gus", "bob doubling: 10 of 10 -> 8 of 10"
    )
    ran = course("grade late out --roster next.csv --dry-run --json")
    assert ran.json["dropped"] == ["gus"]
    write(out.parent, "class/ada/doubling.py")
    again = course(f"{RUN} --resume --roster next.csv")
    again.says("bob doubling: 10 of 10 -> 8 of 10", "leaves the roster: gus")
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
    assert course("grade late out --roster first.csv").code == 0
    write(out.parent, "sheet.csv", WORKSHEET)
    filled = "grade export out --format moodle-worksheet --exercise doubling --roster sheet.csv"
    course(filled, "-o", "back.csv").ends(0)
    rows = (out.parent / "back.csv").read_text().splitlines()
    assert [row.split(",")[4] for row in rows] == ["Grade", "10", "10"]
    # The participant numbers are in no field of a user, by which Moodle's grade import looks.
    ran = course("grade export out --format moodle -o moodle.csv")
    assert '"500","A. Lovelace","ada@x.org","10"' in (out.parent / "moodle.csv").read_text("utf-8-sig")
    for words in ("participant numbers", "other people", "--format moodle-worksheet", "'Email address'"):
        assert words in ran.words


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("canvas", "first.csv has neither canvas_id nor sis_user_id, and Canvas needs one of them."),
        ("moodle", "first.csv has no moodle_key, and Moodle needs it."),
        ("moodle-worksheet", "first.csv has no moodle_key, and Moodle needs it."),
    ],
)
def test_a_roster_without_the_column_is_refused_for_that(course, out, name, says):
    error = course(f"grade export out --format {name} --roster first.csv --json").json["error"]
    assert (error["code"], error["message"]) == ("unmatched_students", f"{says} Nothing was written.")
    assert "worksheet" in error["help"] or "Canvas' gradebook export" in error["help"]


def test_scores_are_on_the_scale_of_the_gradebook_that_canvas_gave(course, out):
    """Canvas would rescale what it gets: its own file says how many points an assignment has there."""
    text = CANVAS.replace("Doubling (4711)", '"Doubling, first try (4711)"').replace(",,10\n", ",,5\n")
    write(out.parent, "canvas.csv", text)
    course(TO_CANVAS).ends(0, "doubling has 10 points here and 5 in Canvas")
    head, possible, *rows = for_canvas(out).splitlines()
    assert head.endswith('"Section","Doubling, first try (4711)"')
    assert possible.endswith('"5"')
    assert '"Lovelace, Ada","101","S1","ada","A","5"' in rows
    wrong = course(TO_CANVAS.replace("4711", "9999"), "-o", "wrong.csv")
    wrong.refuses(2, "has no assignment 9999", "Doubling, first try (4711)")
    assert not (out.parent / "wrong.csv").exists()


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
    ran = course(TO_CANVAS)
    rows = list(csv.reader(for_canvas(out).splitlines()))
    assert (rows[1][-1], rows[2][-1], ran.code) == (score, score, 0)
    assert told in ran.out
    assert len(ran.out.splitlines()) == 1 + bool(told)


def test_whom_canvas_excuses_stays_excused(course, out):
    canvas_has(out, "bob", "EX")
    ran = course(TO_CANVAS)
    assert '"bob","A","EX"' in for_canvas(out), "an empty cell takes the excuse away"
    assert "nothing graded here, stays so: bob doubling (EX)." in ran.words
    assert course(TO_CANVAS, "--json").json["kept"] == ["bob doubling (EX)"]
    assert course(TO_CANVAS, "--overwrite").code == 0
    assert '"bob","A","10"' in for_canvas(out)


def test_a_score_that_canvas_has_is_no_zero_where_nothing_was_handed_in(course, out):
    canvas_has(out, "gus", "8.50")
    ran = course(TO_CANVAS, "--missing", "zero", "--json")
    assert '"gus","A","8.50"' in for_canvas(out)
    assert ran.json["kept"] == ["petitgus_107 doubling (8.50)"]
    assert course(TO_CANVAS, "--missing", "zero", "--overwrite").code == 0
    assert '"gus","A","0"' in for_canvas(out)
    canvas_has(out, "gus", "-1.5")
    assert course(TO_CANVAS, "--missing", "zero").code == 0
    assert '"gus","A","-1.5"' in for_canvas(out), "points below zero are no formula"
    canvas_has(out, "gus", "=1+1")
    for more in ("", " --missing zero"):
        course(TO_CANVAS + more).ends(0, "'=1+1' for petitgus_107 doubling begins like a")
        assert '"gus","A",""' in for_canvas(out)


def test_what_canvas_has_and_we_have_not_is_written_back(course, out):
    canvas_has(out, "gus", '"7,50"')
    assert course(TO_CANVAS, "--overwrite").code == 0
    assert '"gus","A","7,50"' in for_canvas(out)
    for theirs, ours in (("-1.5", "-1.5"), ("=cmd|'/C calc'!A0", ""), ("N/A", "N/A")):
        canvas_has(out, "gus", f'"{theirs}"')
        ran = course(TO_CANVAS).ends(0)
        assert f'"gus","A","{ours}"' in for_canvas(out)
        assert ("begins like a formula" in ran.words) == (not ours)
    course(f"{FOR_CANVAS} --partial").ends(0)
    assert "an empty cell takes away the score or the excuse (EX)" in course(FOR_CANVAS).words


@pytest.mark.usefixtures("ungraded")
def test_another_assignment_of_moodle_s_is_refused_before_it_doubles_the_class(course, tmp_path):
    for folder, number in (("first", 52001), ("second", 63007)):
        for at, name in enumerate(("Ada Lovelace", "Bob Byrne")):
            write(tmp_path / folder, f"{name}_{number + at}_assignsubmission_file_/doubling.py")
    course("grade run first --out out --exercise doubling").ends(0)
    before = (tmp_path / "out" / "grades.csv").read_bytes()
    other = course("grade run second --out out --exercise doubling --resume")
    other.refuses(2, "there Ada Lovelace_52001 has another number (Ada Lovelace_63007 here)")
    assert (tmp_path / "out" / "grades.csv").read_bytes() == before
    course("grade run first --out out --exercise doubling --resume").ends(0)


def test_a_roster_from_a_spreadsheet_is_read(tmp_path):
    text = "Student\tName\tE-mail\nada\tAda Lovelace\tada@x.org\n"
    (tmp_path / "r.txt").write_bytes(text.replace("E-mail", "EMAIL").encode("utf-16"))
    (person,) = read_roster(tmp_path / "r.txt").people
    assert (person.student, person.name, person.email) == ("ada", "Ada Lovelace", "ada@x.org")


def test_a_time_names_a_student_as_a_score_by_hand_does(course, out):
    write(out.parent, "named.csv", "student,name\nada,Ada Lovelace\nbob,Bob Byrne\n")
    write_times(out.parent, ("Ada Lovelace", "2031-01-01T00:00:00Z"))
    assert course("grade late out --roster named.csv --policy late.toml").code == 0
    ran = course("grade late out --times times.csv --json")
    assert ran.json["unknown_names"] == []
    assert "ada" in {one["student"] for one in ran.json["late"]}


def test_a_worksheet_s_numbers_are_not_what_a_student_is_known_by(course, out):
    write(out.parent, "own.csv", "student,name,moodle_key\nada,Ada Lovelace,ada@uni.example\n")
    head = "Identifier,Full name,Grade,Maximum Grade,Last modified (grade)"
    write(out.parent, "sheet.csv", f"{head}\nParticipant 500,Ada Lovelace,,10,-\n")
    for kind in ("moodle --roster own.csv", "moodle-worksheet --roster sheet.csv", "moodle"):
        course(f"grade export out --exercise doubling --partial --format {kind}").ends(0)
    assert "ada@uni.example" in (out / "moodle.csv").read_text()
    assert ",10," in (out / "moodle-worksheet.csv").read_text()


def test_the_student_for_tests_stops_no_export(course, tmp_path):
    make_book(tmp_path / "out", {"lovelaceada_101": RIGHT, "studenttest_999": RIGHT}).close()
    write(tmp_path, "canvas.csv", CANVAS + '"Student, Test",999,,x,A,\n')
    ran = course(TO_CANVAS).ends(0)
    assert "studenttest_999 is Canvas' student for tests and was left out." in ran.words
    assert "999" not in for_canvas(tmp_path / "out")
    write(tmp_path, "canvas.csv", CANVAS)
    assert course(TO_CANVAS).code == 0


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


GERMAN = (
    'ID,"Vollständiger Name",E-Mail-Adresse,Status,Bewertung,Bestwertung,"Bewertung kann geändert werden",'
    '"Zuletzt geändert (Abgabe)","Zuletzt geändert (Bewertung)","Feedback als Kommentar"\n'
    'Teilnehmer/in101,Ada,ada@x.org,Abgegeben,,"20,00",Ja,-,-,\n'
    'Teilnehmer/in102,bob,bob@x.org,Abgegeben,,"20,00",Nein,-,-,\n'
)


def test_a_roster_in_a_western_code_page_and_a_german_worksheet_are_read(course, out):
    (out.parent / "latin.csv").write_bytes("student,name\nada,Ada Müller\nbob,Bob\n".encode("latin-1"))
    assert course("grade export out --roster latin.csv").code == 0
    assert grades(out / "grades.csv")["ada"]["name"] == "Ada Müller"
    write(out.parent, "german.csv", GERMAN)
    course("grade export out --format moodle-worksheet --exercise doubling --roster german.csv").ends(0)
    head, ada, bob = (out / "moodle-worksheet.csv").read_text("utf-8").splitlines()
    assert head.startswith("ID,Vollständiger Name")
    assert ',"20","20,00",' in ada or ',20,"20,00",' in ada
    assert ',,"20,00",Nein' in bob


def test_a_student_is_called_as_the_roster_calls_her(course, out):
    course(TO_CANVAS).ends(0)
    for name in ("Lovelace, Ada", "ada lovelace", "101", "S1", "ada"):
        ran = course("grade explain out", name, "doubling")
        assert ran.out.startswith("ada (Lovelace, Ada), doubling"), (name, ran.err)
    by_hand = course("grade override out 'Byrne, Bob' doubling --score 9 --reason oral")
    by_hand.says("bob doubling: 9 of 10 counts")
    course("grade log out 'Byrne, Bob'").says("bob doubling: oral")
    course("grade explain out Nobody doubling").ends(5)


@pytest.fixture
def moodle(tmp_path):
    """The gradebook of two students of Moodle's, beside it a policy; the folder they are in."""
    make_book(tmp_path / "out", {"Ada_101": RIGHT, "Bob_102": RIGHT}).close()
    write(tmp_path, "late.toml", STRICT)
    return tmp_path


@pytest.mark.parametrize(
    "words",
    [
        "Thursday, {0.day} {0:%B} {0.year}, {0:%I}:{0:%M} {0:%p}",
        "Thursday, {0:%B} {0.day}, {0.year}, {0.hour}:{0:%M}",
    ],
)
def test_moodles_worksheet_says_when_work_was_handed_in(course, moodle, words):
    at = DUE + dt.timedelta(days=1, hours=1)
    sheet = (
        'Identifier,"Full name","Email address",Status,Grade,"Last modified (submission)",'
        f'"Last modified (grade)"\nParticipant 101,Ada,a@x.org,Submitted,,"{words.format(at)}",-\n'
        "Participant 102,Bob,b@x.org,No,,-,-\n"
    )
    write(moodle, "sheet.csv", sheet)
    told = "grade late out --times sheet.csv --exercise doubling"
    course(told).warns("no deadline for doubling")
    course(told, "--policy", "late.toml").says(
        "Ada_101 doubling: 1 d 1 h late", "1 has no trusted submission time; it counts as on time."
    )
    # Over a Sunday on which the clock may change, Moodle's words are an hour too vague for a penalty.
    write(moodle, "march.toml", STRICT.replace("2026-12-01", "2027-03-27"))
    for day, hour, unsure in ((29, 0, True), (29, 1, False), (28, 0, True), (27, 0, False)):
        late = dt.datetime(2027, 3, day, hour, 30)
        write(moodle, "sheet.csv", sheet.replace(words.format(at), words.format(late)))
        ran = course(told, "--policy", "march.toml")
        assert (ran.code, "points of Ada_101" in ran.err) == (0, unsure), (day, hour, ran.err)
    write(moodle, "sheet.csv", sheet.replace(words.format(at), "gestern"))
    course(told).refuses(2, "'gestern' is not a time")


SHEET = (
    'Identifier,"Full name","Email address",Status,Grade,"Maximum Grade","Last modified (submission)",'
    '"Last modified (grade)"\n'
)
LATE_BY_SHEET = "grade late out --times sheet.csv --exercise doubling --policy late.toml"


def handed_in(number, name, status="Submitted"):
    at = DUE + dt.timedelta(days=1, hours=1)
    return f'Participant {number},{name},x@y.org,"{status}",,10,"{at:%A, %d %B %Y, %H:%M}",-\n'


def test_a_number_of_moodles_beats_a_namesake_and_rows_that_fit_nobody_are_named(course, tmp_path):
    who = {"Kim_101": "101", "Kim_102": "102"}
    with make_book(tmp_path / "out", dict.fromkeys(who, RIGHT)) as book:
        book.set_students({name: PlatformIdentity("moodle", one, "Kim") for name, one in who.items()})
    write(tmp_path, "late.toml", STRICT)
    write(tmp_path, "sheet.csv", SHEET + handed_in(101, "Kim") + handed_in(103, "Lou"))
    ran = course(LATE_BY_SHEET).says("Kim_101 doubling: 1 d 1 h late")
    ran.warns("The gradebook has no one student for the row of Lou_103 in sheet.csv.")
    write(tmp_path, "sheet.csv", SHEET + handed_in(101, "Kim"))
    export = "grade export out --format moodle-worksheet --roster sheet.csv"
    course(export).warns(
        "1 student. In one row with 'Kim_101': 'Kim_102'.", "is one student in a new run (another --out)"
    )
    course(export, "--partial", "-o", "sheet-filled.csv").ends(0)
    filled = csv.DictReader((tmp_path / "sheet-filled.csv").read_text("utf-8").splitlines())
    assert [row["Grade"] for row in filled] == ["8"], "the row of the number was not hers"


def test_who_is_late_and_has_more_time_in_moodle_is_named_until_it_is_given_here(course, moodle):
    until = "Zur Bewertung abgegeben - Verlängerung bis: Donnerstag, 3. Dezember 2026, 23:59"
    write(moodle, "sheet.csv", SHEET + handed_in(101, "Ada", until) + handed_in(102, "Bob"))
    course(LATE_BY_SHEET).warns("By sheet.csv, Moodle gave Ada_101 more time.")
    write(moodle, "late.toml", STRICT + '[[extension]]\nstudent = "Ada_101"\ndays = 3\n')
    ran = course(LATE_BY_SHEET).ends(0, "Bob_102 doubling: 1 d 1 h late")
    assert ran.err == ""


def test_an_hour_of_summer_time_that_costs_points_of_an_extension_is_named(course, moodle):
    named = []
    for due, days in (("2026-10-24", 1), ("2026-10-27", 1), ("2026-10-25", 0)):
        write_policy(moodle, f"{due}T23:59:00+02:00", Ada_101=days)
        at = dt.datetime.fromisoformat(f"{due}T23:30:00+01:00") + dt.timedelta(days=min(days, 1))
        write_times(moodle, ("Ada_101", at.isoformat()))
        ran = course("grade late out --policy late.toml --times times.csv")
        named.append("points of Ada_101: with `zone =" in ran.err)
    assert named == [True, False, False]


def test_a_german_worksheet_is_told_of_by_its_own_headings(course, moodle):
    headings = ["ID", "Vollständiger Name", "Bewertung", "Zuletzt geändert (Bewertung)"]
    export = "grade export out --format moodle-worksheet --roster sheet.csv"
    write(moodle, "sheet.csv", ",".join(headings) + "\nTeilnehmer/in 101,Ada,,-\n")
    told = course(export).warns(
        f"sheet.csv has the columns {', '.join(headings)}.",
        "was looked for in ID, Vollständiger Name; it has",
    )
    assert "Full name" not in told.err
    rows = (",".join(headings[:3]), "Teilnehmer/in 101,Ada,", "Teilnehmer/in 102,Bob,")
    write(moodle, "sheet.csv", "\n".join(rows))
    course(export).warns("it has no column 'Zuletzt geändert (Bewertung)', without which Moodle")


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
def test_with_a_zone_a_day_ends_at_the_same_time_of_day(course, moodle, day, days, handed_in, costs):
    write_times(moodle, ("Ada_101", handed_in))
    for zone, cost in zip(("Europe/Berlin", ""), costs, strict=True):
        write_policy(moodle, day, f'points_per_day = 1\nzone = "{zone}"', Ada_101=days)
        told = course("grade late out --policy late.toml --times times.csv --json")
        assert sum(one["penalty"] for one in told.json["late"]) == cost
        assert ("If the clock changed" in told.err) == (cost != costs[0])


def test_a_zone_that_is_not_known_is_refused_by_its_line(course, moodle):
    for zone in ("Europe/Nowhere", "../etc", "Europe"):
        write(moodle, "late.toml", f'zone = "{zone}"\n{POLICY}')
        error = course("grade late out --policy late.toml --json").json["error"]
        assert error["code"] == "invalid_policy"
        assert error["message"] == f"late.toml:1: {zone!r} is no time zone that is known here."
