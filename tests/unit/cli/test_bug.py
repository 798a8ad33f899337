"""``course bug``: versions, levels and the last traceback, and nothing that says whose they are."""

import os
import platform
import tempfile
from pathlib import Path
from types import SimpleNamespace

import pytest

from course import __file__ as package
from course import __version__
from course.cli.frame.app import INSTALLATION
from course.cli.setup import doctor
from tests.unit.cli.conftest import Said

USER, HOST = "planted.person", "planted-laptop"


@pytest.fixture
def somebody(monkeypatch, tmp_path):
    """A user, a home and a machine with names that must not come out; the folder of temporary files."""
    home = tmp_path / "homes" / USER
    (home / "stuff").mkdir(parents=True)
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    monkeypatch.setenv("HOME", str(home))
    monkeypatch.setenv("USERPROFILE", str(home))
    for name in ("USER", "LOGNAME", "USERNAME"):
        monkeypatch.setenv(name, USER)
    monkeypatch.setattr(platform, "node", lambda: f"{HOST}.example.org")
    monkeypatch.setattr(tempfile, "tempdir", str(temporary))
    return home, temporary


HERE = f"{INSTALLATION}{Path(package).resolve().parent}\n"


def test_a_report_names_nobody(course, somebody, monkeypatch, tmp_path):
    home, temporary = somebody
    windows = f"C:\\Users\\{USER}\\x.py"
    machines = f"{HOST} or {HOST.upper()}.EXAMPLE.ORG"
    said = f"no {home / 'stuff' / 'x.py'} nor {windows!r} on {machines} of {USER.title()}"

    def break_():
        raise RuntimeError(said)

    course.faulty = True
    with monkeypatch.context() as broken:
        broken.setattr(doctor, "load_catalog", break_)
        assert course("doctor -C .").code == 70
    assert list(temporary.glob("course-crash-*.txt"))
    reply = course("bug --json").ends(0).json
    assert reply["traceback"] is True
    text = Path(reply["file"]["path"]).read_text("utf-8")
    Said(text.lower()).lacks(*(one.lower() for one in (USER, HOST, str(home), str(tmp_path))))
    # Frames are still told apart.
    Said(text).says("RuntimeError", "~/stuff/x.py".replace("/", os.sep), "<course>", "doctor.py")


@pytest.mark.parametrize(
    "written",
    [
        "/srv/Jürgen_thesis/x.py", "/home/Ju\u0308rgen/x", "file:///home/J%C3%BCrgen/x", r"'J\xfcrgen'",
        r'"J\u00fcrgen"', "JU\u0308RGEN", "planted-laptop_backup", "/media/Jürgen Planted/x",
    ],
)  # fmt: skip
def test_a_name_is_known_however_it_is_spelt(monkeypatch, written):
    """In a folder's name, with its accents apart, and as a string or an address has it."""
    monkeypatch.setattr(doctor, "_places", lambda: [("/home/Jürgen", "~")])
    names = [("Jürgen Planted", "<user>"), ("Jürgen", "<user>"), (HOST, "<machine>")]
    monkeypatch.setattr(doctor, "_names", lambda: names)
    found = doctor.redacted(written).casefold()
    assert not [part for part in ("rgen", "planted") if part in found]


def test_the_name_in_full_is_one_of_them(somebody, monkeypatch):
    pwd = pytest.importorskip("pwd")
    monkeypatch.setattr(pwd, "getpwuid", lambda _: SimpleNamespace(pw_gecos="Ada Planted,,,", pw_name=USER))
    assert doctor.redacted("/media/Ada Planted/disk and adaptive") == "/media/<user>/disk and adaptive"


def test_a_report_has_versions_and_the_level_and_keeps_the_one_before(course, somebody, tmp_path):
    Path("it.txt").write_text("mine")
    course("bug -o it.txt").says("it.txt")
    versions = f"course {__version__}, Python {platform.python_version()}"
    text = Path("it.txt").read_text("utf-8")
    Said(text).says(versions, "protection: L", "msgspec", "No crash of the course was found")
    (kept,) = tmp_path.glob("it.old-*.txt")
    assert kept.read_text() == "mine"


def test_what_was_typed_is_left_out_and_so_is_a_crash_of_another_installation(course, somebody):
    crash = somebody[1] / "course-crash-1.txt"
    crash.write_text(f"{INSTALLATION}/opt/other/course\nTraceback\n")
    assert course("bug --json").json["traceback"] is False
    typed = "command: ['course', 'grade', 'override', 'Anna Student']"
    crash.write_text(f"course 1\n{HERE}{typed}\n\nTraceback\n")
    course("bug")
    Said(Path("course-bug.txt").read_text("utf-8")).says("Traceback").lacks("Anna")


def test_the_newest_crash_counts_and_a_link_is_none(course, somebody, tmp_path):
    _, temporary = somebody
    for number, when in ((1, 1_000.0), (2, 3_000.0), (3, 2_000.0)):
        path = temporary / f"course-crash-{number}.txt"
        path.write_text(f"{HERE}crash number {number}")
        os.utime(path, (when, when))
    (tmp_path / "other").write_text("somebody else's")
    (temporary / "course-crash-4.txt").symlink_to(tmp_path / "other")
    course("bug")
    text = Path("course-bug.txt").read_text("utf-8")
    Said(text).says("crash number 2", "hours ago").lacks("somebody else's")
