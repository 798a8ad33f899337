"""One class with everyone in it: right, wrong, hostile and broken; graded in one run, and then again."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.contracts.boundary.levels import require_level
from tests.journeys.processes import left_running

ROOT = Path(__file__).resolve().parents[2]
SOLUTIONS = ROOT / "solutions" / "integrators"
ATTACKS = ROOT / "tests" / "attacks"
MODEL = (SOLUTIONS / "integrators.py").read_bytes()
WRONG = (ATTACKS / "wrong_integrators.py").read_bytes()
MODULE = "integrators.py"

pytestmark = pytest.mark.soak


def _write(content: bytes) -> Callable[[Path], object]:
    return lambda place: (place / MODULE).write_bytes(content)


def _link(place: Path) -> None:
    (place.parent.parent / "elsewhere.py").write_bytes(MODEL)
    (place / MODULE).symlink_to(place.parent.parent / "elsewhere.py")


def _ambiguous(place: Path) -> None:
    (place / MODULE).write_bytes(MODEL)
    (place / "integrators").mkdir()
    (place / "integrators" / MODULE).write_bytes(WRONG)


#: name of the student -> how the folder is filled, and the reason it cannot be graded
BROKEN: dict[str, tuple[Callable[[Path], object], str]] = {
    "no file": (lambda _: None, "no_file"),
    "empty": (_write(b""), "empty_file"),
    "blank": (_write(b"\n \n"), "empty_file"),
    "syntax error": (_write(b"def explicit_euler_step(:\n"), "syntax_error"),
    "undeclared latin-1": (_write(b"# caf\xe9\n" + MODEL), "syntax_error"),
    "tabs and spaces": (_write(b"if True:\n\tx = 1\n        y = 2\n"), "syntax_error"),
    "a link": (_link, "symlink"),
    "a folder": (lambda place: (place / MODULE).mkdir(), "not_a_file"),
    "two files": (_ambiguous, "ambiguous_files"),
    "all missing": (_write(b"x = 1\n"), "no_declared_functions"),
    "raises on import": (_write(b"1 / 0\n"), "import_error"),
    "too large": (_write(b"#" * (1 << 21)), "too_large"),
    "a zip that is none": (lambda place: (place / "mine.zip").write_bytes(b"PK"), "refused_archive"),
}
#: name of the student -> a file that is odd and still right
ODD: dict[str, bytes] = {
    "byte-order mark": b"\xef\xbb\xbf" + MODEL,
    "CRLF": MODEL.replace(b"\n", b"\r\n"),
    "declared latin-1": b"# -*- coding: latin-1 -*-\n# caf\xe9\n" + MODEL,
    "=HYPERLINK(1)": MODEL,
    "../../up": MODEL,
    "Ada\u202eevoL": MODEL,
    "new\nline": MODEL,
    "NUL bytes": MODEL + b"\0",
    "imports what is not there": b"import absent\nG = len(absent.G)\n" + MODEL,
    "exits": MODEL + b"\nraise SystemExit\n",
    "a line that is no Python": MODEL + b"\nx = = 1\n",
}


def make_class(folder: Path) -> dict[str, str]:
    """Fill the folder; returns what each student is an example of."""
    kinds: dict[str, str] = {}

    def hand_in(student: str, kind: str, fill: Callable[[Path], object]) -> None:
        place = folder / student.replace("/", "\u2215")
        place.mkdir(parents=True)
        fill(place)
        kinds[place.name] = kind

    for kind in ("accepted", "mutants"):
        for path in sorted((SOLUTIONS / kind).glob("*.py")):
            hand_in(f"{kind} {path.stem}", kind, _write(MODEL + b"\n\n" + path.read_bytes()))
    for name in tomllib.loads((ATTACKS / "attacks.toml").read_text("utf-8")):
        path = ATTACKS / f"{name}.py"
        if path.exists():
            hand_in(f"attack {name}", "attack", _write(WRONG + b"\n\n" + path.read_bytes()))
    for name, (fill, _) in BROKEN.items():
        hand_in(name, "broken", fill)
    for name, content in ODD.items():
        hand_in(name, "odd", _write(content))
    hand_in("one missing", "one missing", _write(MODEL + b"\ndel rk4_step\n"))
    hand_in("model", "odd", _write(MODEL))
    hand_in("wrong", "wrong", _write(WRONG))
    return kinds


def grade(folder: Path, out: Path) -> tuple[int, dict[str, dict[str, Any]]]:
    command = [sys.executable, "-m", "course", "grade", "run", str(folder), "--exercise", "integrators"]
    command += ["--out", str(out), "-j", "2", "--timeout", "2", "--seed", "11", "--quiet"]
    # Temporary files of its own, so that what is left there is this run's.
    scratch = out.parent / "scratch"
    scratch.mkdir(exist_ok=True)
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "TMPDIR": str(scratch)}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    lines = (out / "results.jsonl").read_text("utf-8").splitlines()
    return done.returncode, {line["student"]: line for line in map(json.loads, lines)}


def test_a_class_of_every_kind_is_graded_as_each_deserves(tmp_path: Path) -> None:
    require_level("L3")
    kinds = make_class(tmp_path / "class")
    code, results = grade(tmp_path / "class", tmp_path / "out")
    assert code == 6
    assert results.keys() == kinds.keys()
    assert not [name for name, line in results.items() if line["state"] == "grader_error"]

    for name, kind in kinds.items():
        line = results[name]
        failed = {check["task"] for check in line["checks"] if check["status"] != "pass"}
        if kind in {"accepted", "odd"}:
            assert (line["score"], line["max_score"]) == (100, 100), name
        elif kind == "mutants":
            assert line["score"] < 100, name
            assert len(failed) == 1, name
        elif kind == "attack":
            assert line["score"] <= results["wrong"]["score"], name
        elif kind == "broken":
            assert (line["state"], line["score"], line["checks"]) == ("ungradable", 0, []), name
            assert line["error"]["code"] == BROKEN[name][1], name
            assert line["error"]["help"], name
    assert failed_tasks(results["one missing"]) == {"rk4_step"}
    assert all(line["isolation"] == "L3" for line in results.values() if line["state"] == "graded")

    assert not list((tmp_path / "scratch").iterdir())
    assert not left_running(tmp_path)
    code, again = grade(tmp_path / "class", tmp_path / "again")
    assert code == 6
    assert _scores(again) == _scores(results)


def _scores(results: dict[str, dict[str, Any]]) -> dict[str, float]:
    return {name: line["score"] for name, line in results.items()}


def failed_tasks(line: dict[str, Any]) -> set[str]:
    return {check["task"] for check in line["checks"] if check["status"] != "pass"}
