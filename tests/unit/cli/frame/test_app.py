"""The program as a whole: its help, its words, its one object, and the one place where errors end."""

import errno
import io
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from course.cli.frame import registry
from course.cli.frame.console import Stream, filled
from course.cli.frame.options import global_options
from course.cli.frame.registry import ALSO, COMMANDS
from course.cli.setup import doctor
from course.errors import ContentError
from tests.command_line import ROOT, as_process
from tests.unit.cli.conftest import MINI_COURSE, as_anybody, needs_setpriv

HEAVY = {"numpy", "matplotlib", "pymunk", "pytest", "msgspec", "sqlite3", "textual", "nbformat"}


def _imported(*words, **environ):
    """The packages that are imported meanwhile."""
    ran = subprocess.run(
        [sys.executable, "-X", "importtime", *words],
        env={**os.environ, "PYTHONPATH": str(ROOT), **environ},
        capture_output=True, text=True, encoding="utf-8", timeout=120, check=True,
    )  # fmt: skip
    return {line.rpartition("|")[2].strip().partition(".")[0] for line in ran.stderr.splitlines()}


#: All but groups.
WHOLE = [name for name, one in registry.COMMANDS.items() if not one.is_group]


@pytest.mark.parametrize("name", WHOLE)
def test_every_command_has_its_own_summary_and_help_with_an_example(course, name):
    entry = registry.COMMANDS[name]
    assert registry.find(entry.module, entry.name).__doc__.splitlines()[0] == entry.summary
    course(name, "--help").ends(0, entry.summary, f"Example: course {name} {entry.given}".rstrip())


def test_the_list_of_commands_names_them_all(course):
    words = course("--help").out
    for one in ("check", "engines compare", "grade run", "author new exercise"):
        course(*one.split(), "--help").says("also takes --json, --plain", f"Example: course {one}")
    for name, entry in registry.COMMANDS.items():
        assert re.search(rf"^\s+{name}\s+{re.escape(entry.summary)}", words, re.MULTILINE)
        assert not entry.is_group or "..\n" not in course(name, "--help").out.replace("]...\n", ""), "uncut"


@pytest.mark.parametrize(("environ", "needed"), [({}, "typer"), ({"FORCE_COLOR": "1"}, "rich")])
def test_help_loads_nothing_heavy(environ, needed):
    loaded = _imported("-m", "course", "--help", **environ)
    assert needed in loaded
    assert not loaded & HEAVY


def test_a_lesson_opens_without_numpy_and_matplotlib():
    """They cost a quarter of the time to the first page, and no page needs them."""
    modules = "course.cli.frame.app, course.cli.reading.commands, course.cli.reading.screen.app"
    drawing = "course.cli.reading.screen.running"
    loaded = _imported("-c", f"import {modules}, {drawing}")
    assert "textual" in loaded
    assert not loaded & {"numpy", "matplotlib", "PIL"}


@pytest.mark.parametrize("words", [["--version"], ["--version", "--json"], ["check", "--version"]])
def test_version_wins_wherever_it_stands(course, words):
    ran = course(*words).ends(0)
    assert "course " in ran.out + ran.err


# -- one object ----------------------------------------------------------------------------------------

#: The codes of names that there are not, and the near ones that are offered.
NOT_FOUND = {
    "lesson twice": ("lesson_not_found", "twice-as-much"),
    "start doublin": ("exercise_not_found", "doubling"),
    "sim run fre-fall": ("simulation_not_found", "free-fall"),
    "chekc": ("usage", "'check'"),
}


@pytest.mark.parametrize(
    ("line", "schema", "code"),
    [
        ("", "course.status/2", 0),
        ("lesson twice", "course.lesson/1", 5),
        ("start doublin", "course.start/1", 5),
        ("check doubling", "course.check/1", 1),
        ("check --all", "course.check-all/1", 1),
        ("solution doubling", "course.solution/1", 5),
        ("submit", "course.submit/1", 3),
        ("--help", "course.help/1", 0),
        ("check --help", "course.help/1", 0),
        ("check --nonsense", "course.check/1", 2),
        ("chekc", "course.error/1", 2),
        ("check one two", "course.check/1", 2),
        ("check --all --nonsense", "course.check-all/1", 2),
        ("demo extra", "course.demo/2", 2),
        ("quiz history --nonsense", "course.quiz-history/1", 2),
        ("sandbox list nothing-like-it", "course.sandbox-list/1", 5),
        ("sim run --all --nonsense", "course.sim-all/1", 2),
        ("sim run fre-fall", "course.sim/1", 5),
        ("author new lesson", "course.author-new/1", 2),
        ("author", "course.error/1", 2),
        ("-C nowhere check", "course.check/1", 5),
        ("check -C", "course.check/1", 2),
        ("reset", "course.reset/1", 2),
    ],
)
def test_every_command_prints_exactly_one_object(course, workspace, line, schema, code):
    ran = course("--json", *line.split())
    body = ran.json
    assert ran.out.count("\n") == 1
    assert (body["schema"], body["exit_code"], ran.code) == (schema, code, code)
    if "error" in body:
        assert set(body["error"]) == {"code", "message", "help"}
        assert body["error"]["message"] in ran.err
    if line in NOT_FOUND:
        code, near = NOT_FOUND[line]
        assert body["error"]["code"] == code
        assert near in body["error"]["message"] + body["error"]["help"]


# -- the boundary ----------------------------------------------------------------------------------------


@pytest.fixture
def failing(course, monkeypatch):
    """Make ``course doctor`` end by raising something."""

    def arrange(error):
        def doctor_that_fails():
            """Say what works on this machine."""
            raise error

        monkeypatch.setattr(doctor, "doctor", doctor_that_fails)
        course.faulty = True
        return course

    return arrange


def test_a_deliberate_error_is_message_help_and_exit_code(failing):
    ran = failing(ContentError(Path("f.toml"), 3, "m", help="h"))("doctor")
    assert (ran.code, ran.out, ran.err) == (70, "", "f.toml:3: m\nh\n")


@pytest.mark.parametrize(
    "error", [ZeroDivisionError("secret"), RecursionError(), MemoryError(), OSError("disk")]
)
def test_anything_else_is_one_line_and_a_report_in_a_file(failing, error, tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    ran = failing(error)("doctor").ends(70)
    assert ran.err.count("\n") == 1
    assert "Traceback" not in ran.err
    report = Path(re.search(r"details are in (.+)\.$", ran.err.strip())[1])
    assert "Traceback" in report.read_text()
    assert type(error).__name__ in report.read_text()


def test_a_crash_whose_report_cannot_be_written_is_still_one_line_and_in_the_envelope(
    failing, tmp_path, monkeypatch
):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "not there"))
    ran = failing(ZeroDivisionError())("doctor --json")
    assert (ran.code, ran.json["error"]["code"], ran.json["schema"]) == (70, "internal", "course.doctor/1")
    assert ran.err.count("\n") == 1


@pytest.mark.skipif(os.name == "nt", reason="a process cannot be sent Ctrl-C alone")
def test_ctrl_c_while_the_program_is_loaded_shows_no_traceback():
    with subprocess.Popen(
        [sys.executable, "-X", "importtime", "-m", "course", "--version"],
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
    ) as started:  # fmt: skip
        assert started.stderr
        for line in started.stderr:
            if line.endswith(" typer.colors\n"):
                started.send_signal(signal.SIGINT)
                break
        assert "Traceback" not in started.stderr.read()
    assert started.returncode == -signal.SIGINT


def test_ctrl_c_exits_130_and_is_told_in_one_word(failing):
    ran = failing(KeyboardInterrupt())("doctor")
    assert (ran.code, ran.err) == (130, "Interrupted.\n")
    assert failing(KeyboardInterrupt())("doctor --json").json["error"]["code"] == "interrupted"


def test_what_a_library_prints_does_not_join_the_object(course, monkeypatch):
    def noisy():
        """Say what works on this machine."""
        print("noise")
        return 0

    monkeypatch.setattr(doctor, "doctor", noisy)
    ran = course("doctor --json")
    assert ran.json == {"schema": "course.doctor/1", "ok": True, "exit_code": 0}
    assert "noise" in ran.err


def test_a_reader_that_stops_reading_is_no_error():
    with subprocess.Popen(
        [sys.executable, "-m", "course", "lessons"],
        env={**os.environ, "PYTHONPATH": str(ROOT), "COURSE_CONTENT": str(MINI_COURSE)},
        stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    ) as read:  # fmt: skip
        read.stdout.close()
        assert (read.wait(120), read.stderr.read()) == (0, b"")


@pytest.mark.skipif(os.name == "nt", reason="has no such shell")
@pytest.mark.parametrize("closed", [">&-", "2>&-", "<&- >&- 2>&-"])
@pytest.mark.parametrize("line", ["", "lessons --json"])
def test_an_output_that_is_closed_is_no_error_either(tmp_path, line, closed):
    script = f'exec "$0" -m course {line} {closed}'
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "COURSE_CONTENT": str(MINI_COURSE)}
    done = subprocess.run(
        ["sh", "-c", script, sys.executable],
        cwd=tmp_path, env=environment, capture_output=True, timeout=120, check=False,
    )  # fmt: skip
    assert (done.returncode, b"Traceback" in done.stderr) == (0, False)


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="has no device that is always full")
@pytest.mark.parametrize("line", ["--version", "--help", "lessons", "lessons --json", "lesson twice-as-much"])
def test_an_output_without_room_is_no_fault_of_the_course(line):
    with Path("/dev/full").open("wb") as full:
        done = subprocess.run(
            [sys.executable, "-m", "course", *line.split()],
            env={**os.environ, "PYTHONPATH": str(ROOT), "COURSE_CONTENT": str(MINI_COURSE)},
            stdout=full, stderr=subprocess.PIPE, text=True, timeout=120, check=False,
        )  # fmt: skip
    said = "The output cannot be written (No space left on device).\nMake room, or write elsewhere.\n"
    assert (done.returncode, done.stderr[-len(said) :]) == (4, said)


def test_a_file_without_room_is_named(failing):
    ran = failing(OSError(errno.ENOSPC, "No space left on device", "there/it.json"))("doctor")
    said = "there/it.json cannot be written (No space left on device).\nMake room, or write elsewhere.\n"
    assert (ran.code, ran.err) == (4, said)


@pytest.mark.parametrize("number", [errno.EACCES, errno.EPERM, errno.EROFS, errno.ENAMETOOLONG, errno.ELOOP])
def test_what_the_file_system_refuses_is_named_and_no_fault_of_the_course(failing, number):
    ran = failing(OSError(number, os.strerror(number), "there/it.json"))("doctor").ends(4)
    assert ran.err.startswith(f"there/it.json cannot be used ({os.strerror(number)}).\n")


_NAMES = {
    "~nobody-here/it": "no home folder ~nobody-here",
    "y" * 300: "File name too long",
    "loop/it": "links",
}


@pytest.mark.parametrize("name", _NAMES)
@pytest.mark.parametrize(
    "line",
    [
        "init {}",
        "check {}.py",
        "diff {}.py",
        "report doubling -o {}",
        "submit -o {}.zip",
        "notebook build --out {}",
        "notebook check {}.ipynb",
        "sandbox play {}.toml",
        "sandbox play billiard-break --png {}.png",
        "sandbox replay {}.run",
        "sim run free-fall --csv {}.csv",
        "engines compare --plot {}.png",
        "bug -o {}",
    ],
)
def test_a_name_that_no_file_can_have_is_named(course, workspace, write, line, name):
    (workspace / "loop").symlink_to("loop")
    write("RIGHT", "RIGHT")
    course(*line.format(name).split()).refuses(2, _NAMES[name])


@needs_setpriv
@pytest.mark.parametrize(
    ("folder", "line", "code", "said"),
    [
        ("doubling", "check doubling", 3, "doubling/doubling.py cannot be read (Permission denied)"),
        ("doubling", "check --all", 3, "0 of 1 exercise pass"),
        ("doubling", "submit", 4, "doubling/doubling.py cannot be used (Permission denied)"),
        ("doubling", "notebook build doubling", 4, "doubling/doubling.ipynb cannot be used"),
        (".course", "", 0, "Next: course doctor"),
        (".course", "doctor", 4, "progress.sqlite cannot be used (Permission denied)"),
        (".course", "progress", 4, "progress.sqlite cannot be used (Permission denied)"),
    ],
)
def test_a_folder_that_cannot_be_read_is_named(workspace, folder, line, code, said):
    (workspace / folder).chmod(0)
    try:
        ran = as_anybody(*line.split(), cwd=workspace)
    finally:
        (workspace / folder).chmod(0o755)
    assert said in ran.stdout + ran.stderr
    assert ran.returncode == code


def test_a_terminal_that_hung_up_is_no_fault_of_the_course():
    class HungUp(io.StringIO):
        def write(self, text):
            raise OSError(errno.EIO, "Input/output error")

    stream = Stream(HungUp())
    assert stream.write("Next: course go") == len("Next: course go")
    stream.flush()


def test_a_disk_that_fails_under_the_output_is_not_passed_over(tmp_path):
    class Failing(io.TextIOWrapper):
        def write(self, text):
            raise OSError(errno.EIO, "Input/output error")

    with Failing((tmp_path / "said.txt").open("wb")) as failing, pytest.raises(OSError, match="Input/output"):
        Stream(failing).write("Next: course go")


def test_the_folder_of_the_student_is_not_importable(tmp_path):
    (tmp_path / "typer.py").write_text("raise SystemExit('hijacked')")
    ran = as_process("--version", cwd=tmp_path)
    assert ran.returncode == 0
    assert "hijacked" not in ran.stderr


@pytest.mark.parametrize("name", ["init", "submit", "quiz", "sandbox", "grade"])
def test_a_help_page_has_its_paragraphs_in_one_piece(name):
    """Rich wraps a text to the terminal, and keeps the breaks that it has."""
    loaded = registry._load(name, registry.COMMANDS[name], "rich")
    for one in (loaded, *getattr(loaded, "commands", {}).values()):
        assert "\n" not in one.help.replace("\n\n", "")


@pytest.mark.parametrize(
    ("word", "own"),
    [
        ("test", ["check"]),
        ("verify", ["check"]),
        ("run", ["check"]),
        ("list", ["exercises"]),
        ("status", []),
        ("warm-ups", ["warmup"]),
        ("version", ["--version"]),
    ],
)
def test_a_word_of_another_tool_does_what_it_means(course, workspace, write, word, own):
    write("RIGHT", "wrong")
    said, meant = course(word, "--json"), course(*own, "--json")
    assert said.code == meant.code
    assert said.json["schema"] == meant.json["schema"]
    assert not {*ALSO} & {*COMMANDS}


def test_a_double_dash_ends_the_search_for_global_options():
    line = global_options(["check", "--", "--json", "-C"])
    assert not line.settings.json
    assert line.rest == ("check", "--", "--json", "-C")
    assert not line.problem


@pytest.mark.parametrize("words", [["-C", "a/b", "check"], ["check", "-Ca/b"], ["-Ca", "check", "-C", "b"]])
def test_the_folder_may_be_attached_and_two_add_up(words):
    line = global_options(words)
    assert line.settings.directory in {"a/b", "a\\b"}
    assert line.rest == ("check",)


def test_help_before_a_command_is_its_help(course):
    assert course("help check").out == course("check --help").out
    assert course("help").out == course("--help").out


@pytest.mark.parametrize("word", ["quit", "exit"])
def test_who_wants_to_leave_is_told_that_nothing_runs(course, word):
    course(word).refuses(2, "every command ends by itself")
    assert course(word, "--json").error == (2, "usage")


def test_a_choice_that_is_missing_is_shown(course, workspace):
    assert "Known: mjcf, sdf." in course("sandbox export head-on").err
    course("start").refuses(2, "Known: doubling")


def test_help_is_grouped_by_use_and_offers_what_works_here(course, students_content, monkeypatch):
    course("--help --plain").says("submit").lacks("For instructors:", "For authors:")
    monkeypatch.setenv("COURSE_CONTENT", str(MINI_COURSE))
    uses = ("Learn", "Practise", "Play", "Hand in", "This machine", "For instructors", "For authors")
    course("--help --plain").says_in_order(*(f"\n{use}:\n" for use in uses))

    monkeypatch.setenv("COURSE_CONTENT", "nowhere")
    assert course("--help --plain").code == 0


@pytest.mark.parametrize(
    "command",
    [
        "`course grade rerun 'my grades' --against 1`",
        "pip install 'starlette>=7.5' 'uvicorn<9,>=8' 'websockets'",
    ],
)
def test_a_command_that_is_copied_is_never_broken(command):
    sentence = f"Grade these again with what the run itself had been graded with: {command}"
    rows = filled(sentence, 40).split("\n")
    assert len(rows) > 1
    assert any(command in row for row in rows)
    assert all(len(row) <= 40 for row in rows if command not in row)
