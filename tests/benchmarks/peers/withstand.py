"""Thirteen plain attacks on nbgrader, otter, check50, a plain pytest process, and on this course's grader.

    python tests/benchmarks/peers/withstand.py [--only check50] [--attack hang] [--venvs DIR] [--out DIR]
                                               [--page docs/peers.md] [--patience 300]

Every grader gets the same exercise (`double` of the miniature course in tests/fixtures): a public test and a
hidden one with a number and a word drawn for the run. A peer is installed by pip in a virtual environment of
its own and used as its documentation tells an instructor to use it on one machine; docs/peers.md has the
addresses. A right and a wrong answer are graded first: whoever does not tell them apart is not measured. What
an attack is, and what counts as its success, is in attacks.py; what it left running is killed afterwards.

Linux only: who is running is read from /proc. Writes peers.json and peers.md to ``--out``; what peers.json
has from earlier runs stays until it is tried again, and stands in both tables.
"""

import argparse
import contextlib
import json
import os
import random
import shutil
import signal
import socket
import sqlite3
import subprocess
import sys
import tempfile
import time
import uuid
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[2]
MINI = ROOT / "tests" / "fixtures" / "mini_course"
sys.path[:0] = [str(ROOT), str(HERE)]

from attacks import ATTACKS, HONEST, WRONG  # noqa: E402
from compare import (  # noqa: E402
    NBGRADER_CONFIG,
    OTTER_GENERATE,
    NotMeasuredError,
    install,
    nbgrader_cell,
    notebook,
    otter_test,
)

from tests.journeys.processes import below, marked, resident, stored  # noqa: E402

#: What is installed for each peer; the rest of what it needs is its own to name. Otter runs notebooks with
#: whatever kernel there is, and names none.
PACKAGES = {
    "nbgrader": ["nbgrader"],
    "otter": ["otter-grader", "ipykernel"],
    "check50": ["check50"],
    "pytest": ["pytest"],
}
OURS = {"course at L3": ("--isolation", "strict"), "course at L1": ("--isolation", "process")}
DISTRIBUTION = {"otter": "otter-grader"}
HELD = 2_500_000_000  # bytes in the memory of one process; a worker of ours may have 2 GB
FILLED = 150_000_000  # bytes on disk that were not there before
WAIT_S = {"leave a daemon": 5.0, "rewrite the result": 10.0}  # before it is looked at what came of it
MARKER = "COURSE_PEERS_RUN"
PUBLIC = "3.0"


@dataclass(frozen=True)
class Place:
    """Where one attack meets one grader."""

    folder: Path  # all that belongs to the run, temporary files included
    number: str  # the hidden input
    word: str  # what the hidden test says when it fails

    @property
    def graders(self) -> Path:
        return self.folder / "graders"

    @property
    def result(self) -> Path:
        return self.folder / "results.json"

    def told(self, key: str) -> list[dict[str, Any]]:
        """A list in the result; empty if there is none."""
        try:
            return json.loads(self.result.read_text("utf-8"))[key]
        except (OSError, ValueError, KeyError):
            return []


# -- graders ------------------------------------------------------------------------------------------------


class Grader:
    """One way of grading: how a class is laid out, what is run, what it says of the hostile student."""

    name = ""
    forge = "raise OSError"

    def __init__(self, programs: Path | None = None) -> None:
        self.programs = programs

    def program(self, name: str) -> str:
        return str(self.programs / name) if self.programs else name

    def environment(self, place: Place) -> dict[str, str]:
        path = f"{self.programs}{os.pathsep}{os.environ['PATH']}" if self.programs else os.environ["PATH"]
        return {"PATH": path, "HOME": str(place.folder / "home")}

    def _run(self, place: Place, folder: Path, *words: str) -> None:
        """One of the instructor's own commands."""
        environment = {**os.environ, **self.environment(place)}
        command = [self.program(words[0]), *words[1:]]
        done = subprocess.run(
            command, cwd=folder, env=environment, capture_output=True, text=True, check=False
        )
        if done.returncode:
            said = f"{words[0]} {words[1]} ended with {done.returncode}: {done.stderr[-500:]}"
            raise NotMeasuredError(said)

    def results(self, place: Place) -> list[Path]:
        """Where it leaves what it found, for an attack that rewrites it."""
        return [place.result]

    def prepare(self, place: Place) -> None:
        """The instructor's side."""

    def submission(self, place: Place, student: str) -> Path:
        return place.folder / "submitted" / student / "doubling.py"

    def hand_in(self, path: Path, source: str) -> None:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(source, "utf-8")

    def command(self, place: Place) -> tuple[list[str], Path]:
        raise NotImplementedError

    def passed(self, place: Place, code: int) -> bool:
        """Whether more is credited than a wrong answer is due."""
        raise NotImplementedError


class Pytest(Grader):
    """One `pytest` process; the tests lie beside the file, as a simple autograder does it."""

    name = "pytest"  # the result is an exit code: no file to rewrite

    def submission(self, place: Place, student: str) -> Path:
        return place.folder / "work" / student / "doubling.py"

    def prepare(self, place: Place) -> None:
        place.graders.mkdir()
        test = f"""from doubling import double


def test_public():
    assert double({PUBLIC}) == 2 * {PUBLIC}


def test_hidden():
    assert double(-{place.number}) == 2 * -{place.number}, "{place.word}"
"""
        (place.graders / "test_doubling.py").write_text(test, "utf-8")

    def command(self, place: Place) -> tuple[list[str], Path]:
        work = self.submission(place, "hostile").parent
        shutil.copy(place.graders / "test_doubling.py", work)
        return [self.program("python"), "-m", "pytest", "-q", "test_doubling.py"], work

    def passed(self, place: Place, code: int) -> bool:
        return code == 0


class Check50(Grader):
    """`check50 --dev`, which reads the checks from a folder; each check starts the student's program."""

    name = "check50"
    forge = """
    text = open(path).read()
    open(path, "w").write(re.sub(r'"passed": (false|null)', '"passed": true', text))"""

    def prepare(self, place: Place) -> None:
        place.graders.mkdir()
        config = 'check50:\n  files:\n    - !exclude "*"\n    - !require doubling.py\n'
        (place.graders / ".cs50.yml").write_text(config, "utf-8")
        call = "python3 -c 'import doubling; print(doubling.double({0}))'"
        checks = f'''import check50


@check50.check()
def exists():
    """doubling.py exists"""
    check50.exists("doubling.py")


@check50.check(exists)
def public():
    """doubles three"""
    check50.run("{call.format(PUBLIC)}").stdout("6.0", regex=False).exit(0)


@check50.check(exists)
@check50.hidden("Try other numbers.")  # {place.word}
def hidden():
    """doubles a negative number"""
    said = check50.run("{call.format("-" + place.number)}")
    said.stdout("{2 * -float(place.number)!r}", regex=False).exit(0)
'''
        (place.graders / "__init__.py").write_text(checks, "utf-8")

    def command(self, place: Place) -> tuple[list[str], Path]:
        made = [self.program("check50"), "--dev", str(place.graders), "-o", "json", "--output-file"]
        return [*made, str(place.result)], self.submission(place, "hostile").parent

    def passed(self, place: Place, code: int) -> bool:
        return any(check["passed"] for check in place.told("results") if check["name"] != "exists")


class Nbgrader(Grader):
    """`nbgrader generate_assignment`, then `nbgrader autograde`; the scores are in its gradebook."""

    name = "nbgrader"
    forge = """
    if not os.path.exists(path): raise OSError
    with sqlite3.connect(path, timeout=1) as book:
        book.execute("UPDATE grade SET auto_score = 2")
        book.commit()"""

    def results(self, place: Place) -> list[Path]:
        return [place.folder / "gradebook.db"]

    def submission(self, place: Place, student: str) -> Path:
        return place.folder / "submitted" / student / "ps1" / "work.ipynb"

    def hand_in(self, path: Path, source: str) -> None:
        """The released notebook, with an answer in the cell that is for it."""
        course = path.parents[3]
        work = json.loads((course / "release" / "ps1" / "work.ipynb").read_text("utf-8"))
        work["cells"][0]["source"] = source
        path.parent.mkdir(parents=True)
        path.write_text(json.dumps(work), "utf-8")

    def prepare(self, place: Place) -> None:
        asserted = f'assert double(-{place.number}) == 2 * -{place.number}, "{place.word}"'
        hidden = f"### BEGIN HIDDEN TESTS\n{asserted}\n### END HIDDEN TESTS"
        cells = [
            nbgrader_cell("answer", "### BEGIN SOLUTION\npass\n### END SOLUTION", None),
            nbgrader_cell("public", f"assert double({PUBLIC}) == 2 * {PUBLIC}", 2.0),
            nbgrader_cell("hidden", hidden, 2.0),
        ]
        source = place.folder / "source" / "ps1"
        source.mkdir(parents=True)
        (source / "work.ipynb").write_text(notebook(cells), "utf-8")
        (place.folder / "nbgrader_config.py").write_text(NBGRADER_CONFIG, "utf-8")
        self._run(place, place.folder, "nbgrader", "generate_assignment", "ps1")

    def command(self, place: Place) -> tuple[list[str], Path]:
        return [self.program("nbgrader"), "autograde", "ps1", "--student", "hostile"], place.folder

    def passed(self, place: Place, code: int) -> bool:
        with contextlib.closing(sqlite3.connect(place.folder / "gradebook.db")) as book:
            return any(score for (score,) in book.execute("SELECT auto_score FROM grade"))


class Otter(Grader):
    """`otter generate`, then `otter run`: the way without a container."""

    name = "otter"
    forge = """
    text = open(path).read()
    open(path, "w").write(re.sub(r'"score": 0(\\.0)?', '"score": 2.0', text))"""

    def submission(self, place: Place, student: str) -> Path:
        return place.folder / "submitted" / student / "work.ipynb"

    def hand_in(self, path: Path, source: str) -> None:
        super().hand_in(path, notebook([{"source": source}]))

    def prepare(self, place: Place) -> None:
        for name, value, hidden in (("public", PUBLIC, False), (place.word, "-" + place.number, True)):
            code = f">>> double({value}) == 2 * {value}\nTrue"
            otter_test(place.graders, name, code, 2, hidden=hidden)
        self._run(place, place.graders, "otter", *OTTER_GENERATE)

    def command(self, place: Place) -> tuple[list[str], Path]:
        work = self.submission(place, "hostile")
        zipped = str(place.graders / "autograder.zip")
        return [self.program("otter"), "run", work.name, "-a", zipped, "-o", str(place.folder)], work.parent

    def passed(self, place: Place, code: int) -> bool:
        return any(float(test.get("score") or 0) > 0 for test in place.told("tests"))


class Ours(Grader):
    """`course grade run`, as it is or with plain processes (L1)."""

    forge = """
    text = open(path).read()
    open(path, "w").write(re.sub(r'"score":\\s*[0-9.]+', '"score":10', text))"""

    def __init__(self, name: str, *options: str) -> None:
        super().__init__()
        self.name, self.options = name, options

    def environment(self, place: Place) -> dict[str, str]:
        return {
            **super().environment(place),
            "COURSE_CONTENT": str(place.folder / "content"),
            "PYTHONPATH": str(ROOT),
        }

    def results(self, place: Place) -> list[Path]:
        return [place.folder / "out" / "results.jsonl"]

    def prepare(self, place: Place) -> None:
        content = place.folder / "content"
        shutil.copytree(MINI, content)
        checks = content / "graders" / "doubling" / "checks.py"
        text = checks.read_text("utf-8")
        drawn = text.replace("-17.25", f"-{place.number}").replace("-34.5", repr(2 * -float(place.number)))
        assert drawn.count(place.number) >= 2
        checks.write_text(drawn.replace("Hidden checks of doubling.", f"Hidden: {place.word}."), "utf-8")

    def command(self, place: Place) -> tuple[list[str], Path]:
        run = [sys.executable, "-m", "course", "grade", "run", str(place.folder / "submitted")]
        run += ["--exercise", "doubling", "--out", str(place.folder / "out"), "--quiet", *self.options]
        return run, place.folder

    def passed(self, place: Place, code: int) -> bool:
        path = self.results(place)[0]
        lines = path.read_text("utf-8").splitlines() if path.exists() else []
        rows = [line for line in map(json.loads, lines) if line["student"] == "hostile"]
        return any(row["score"] > 0 for row in rows)


# -- one attack ---------------------------------------------------------------------------------------------


def prepared(grader: Grader, folder: Path) -> Place:
    """The instructor's side of an exercise with a number and a word of its own."""
    place = Place(folder, f"{random.randint(1000, 9999)}.25", f"w{uuid.uuid4().hex}")
    for path in (place.folder, place.folder / "home", place.folder / "tmp"):
        path.mkdir()
    grader.prepare(place)
    return place


def attack(grader: Grader, made: Place, name: str, source: str, patience_s: float) -> dict[str, Any]:
    """Grade one hostile file; whether the attack did what it wanted, and how long the run took."""
    token = uuid.uuid4().hex
    with tempfile.TemporaryDirectory(prefix="peers-", ignore_cleanup_errors=True) as scratch:
        place = replace(made, folder=Path(scratch) / "run")
        shutil.copytree(made.folder, place.folder)
        canary = place.folder / "notes.txt"
        canary.write_text("the instructor's", "utf-8")
        other = grader.submission(place, "other")
        grader.hand_in(other, WRONG)
        before = other.read_bytes()
        listener = socket.create_server(("127.0.0.1", 0))
        listener.setblocking(False)
        filled = {
            "HIDDEN_A": place.word[:15], "HIDDEN_B": place.word[15:], "TOKEN": token, "CANARY": str(canary),
            "OTHER": str(other), "PORT": str(listener.getsockname()[1]), "FORGE": grader.forge.strip(),
            "RESULTS": repr([str(path) for path in grader.results(place)]),
            "PLACES": repr([str(place.folder)]),
        }  # fmt: skip
        for key, value in filled.items():
            source = source.replace(f"@{key}@", value)
        grader.hand_in(grader.submission(place, "hostile"), source)
        command, folder = grader.command(place)
        bare = {key: value for key, value in os.environ.items() if not key.startswith(("PYTEST_", "JUPYTER"))}
        environment = {
            **bare, **grader.environment(place), MARKER: token, "TMPDIR": str(place.folder / "tmp"),
        }  # fmt: skip
        at_first, most_held, most_stored, in_time = stored(place.folder), 0, 0, True
        start = time.monotonic()
        with (Path(scratch) / "printed").open("wb") as printed:
            run = subprocess.Popen(
                command, cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                stdout=printed, stderr=printed, start_new_session=True,
            )  # fmt: skip
            while run.poll() is None:
                most_held = max(most_held, *map(resident, (run.pid, *below(run.pid))))
                most_stored = max(most_stored, stored(place.folder))
                if time.monotonic() - start > patience_s:
                    in_time = False
                    os.killpg(run.pid, signal.SIGKILL)
                    run.wait()
                time.sleep(0.1)
        seconds = time.monotonic() - start
        try:
            time.sleep(WAIT_S.get(name, 0.0))
            most_stored = max(most_stored, stored(place.folder)) - at_first
            left = bool(marked(token))
            if name in ("hang", "exhaust memory", "fill the disk", "right", "wrong"):
                for pid in marked(token):
                    os.kill(pid, signal.SIGKILL)
            heard = True
            try:
                listener.accept()[0].close()
            except BlockingIOError:
                heard = False
            outcome = {
                "leave a daemon": left,
                "open the network": heard,
                "exhaust memory": most_held >= HELD,
                "fill the disk": most_stored >= FILLED,
                "delete files": not canary.exists(),
                "hang": not in_time,
                "change another submission": not other.exists() or other.read_bytes() != before,
            }
            succeeded = outcome[name] if name in outcome else grader.passed(place, run.returncode)
        finally:
            listener.close()
            for pid in marked(token):
                with contextlib.suppress(ProcessLookupError):
                    os.kill(pid, signal.SIGKILL)
        words = (Path(scratch) / "printed").read_text("utf-8", "replace")
        return {
            "succeeded": bool(succeeded), "seconds": round(seconds, 1), "exit_code": run.returncode,
            "memory_mb": most_held >> 20, "disk_mb": most_stored // 1_000_000, "said": words[-600:],
        }  # fmt: skip


def version(peer: str, programs: Path) -> str:
    asked = f"import importlib.metadata as m; print(m.version({DISTRIBUTION.get(peer, peer)!r}))"
    return subprocess.run(
        [programs / "python", "-c", asked], capture_output=True, text=True, check=True
    ).stdout.strip()


def measure(grader: Grader, names: list[str], patience_s: float) -> Iterator[tuple[str, dict[str, Any]]]:
    """Both controls, then the attacks; `NotMeasuredError` if a control does not come out as it must."""
    with tempfile.TemporaryDirectory(prefix="peers-") as scratch:
        made = prepared(grader, Path(scratch) / "made")
        for control, source, due in (("right", HONEST, True), ("wrong", WRONG, False)):
            found = attack(grader, made, control, source, patience_s)
            if found["succeeded"] is not due:
                raise NotMeasuredError(f"a {control} answer is not told from another: {found['said'][-300:]}")
        for name in names:
            result = attack(grader, made, name, ATTACKS[name][0], patience_s)
            outcome = "SUCCEEDED" if result["succeeded"] else "failed"
            print(f"  {name:30} {outcome:9} {result['seconds']:6.1f} s", flush=True)
            yield name, result


def table(found: dict[str, dict[str, Any]], patience_s: float) -> str:
    """Markdown: an attack a row, a grader a column."""
    found = {name: found[name] for name in (*PACKAGES, *OURS) if name in found}
    head = [f"{name} {one['version']}".strip() for name, one in found.items()]
    lines = ["| attack | what counts as success | " + " | ".join(head) + " |", "|---" * (len(head) + 2) + "|"]
    for name, (_, success) in ATTACKS.items():
        cells = []
        for one in found.values():
            result = one.get("attacks", {}).get(name)
            cells.append("not tried" if not result else "**succeeded**" if result["succeeded"] else "failed")
        lines.append(
            f"| {name} | {success.replace('@PATIENCE@', f'{patience_s:g}')} | " + " | ".join(cells) + " |"
        )
    sums = []
    for one in found.values():
        results = one.get("attacks", {}).values()
        sums.append(f"{sum(result['succeeded'] for result in results)} of {len(results)}")
    lines.append("| succeeded | | " + " | ".join(sums) + " |")
    notes = [f"\n{name}: not measured. {one['why']}" for name, one in found.items() if "why" in one]
    return "\n".join(lines + notes) + "\n"


def in_place(page: str, made: str) -> str:
    """A page with its table of attacks exchanged for another."""
    lines = page.split("\n")
    first = next(number for number, line in enumerate(lines) if line.startswith("| attack |"))
    after = next(number for number in range(first, len(lines)) if not lines[number].strip())
    return "\n".join([*lines[:first], *made.strip().split("\n"), *lines[after:]])


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    kinds = {"nbgrader": Nbgrader, "otter": Otter, "check50": Check50, "pytest": Pytest}
    parser.add_argument("--only", action="append", choices=[*kinds, *OURS])
    parser.add_argument("--attack", action="append", choices=list(ATTACKS))
    parser.add_argument("--venvs", type=Path, help="folder to keep the peers' environments in")
    parser.add_argument("--out", type=Path, default=Path("peers"))
    parser.add_argument("--page", type=Path, help="Markdown whose table is replaced by the one of this run")
    parser.add_argument("--patience", type=float, default=300.0, help="wall seconds until a run is given up")
    options = parser.parse_args()
    if sys.platform != "linux":
        parser.error("reads the process table of Linux")
    options.out.mkdir(parents=True, exist_ok=True)
    written = options.out / "peers.json"
    found: dict[str, dict[str, Any]] = json.loads(written.read_text("utf-8")) if written.exists() else {}
    with contextlib.ExitStack() as stack:
        venvs = options.venvs or Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="peers-venvs-")))
        for name in options.only or [*kinds, *OURS]:
            one = found.setdefault(name, {"version": "", "attacks": {}})
            print(name, flush=True)
            try:
                if name in kinds:
                    programs = install(name, PACKAGES[name], venvs.absolute())
                    one["version"] = version(name, programs)
                    grader: Grader = kinds[name](programs)
                else:
                    grader = Ours(name, *OURS[name])
                for attacked, result in measure(grader, options.attack or list(ATTACKS), options.patience):
                    one["attacks"][attacked] = result
                    written.write_text(json.dumps(found, indent=1) + "\n", "utf-8")
                one.pop("why", None)
            except NotMeasuredError as reason:
                one["why"] = " ".join(str(reason).split())
                print(f"  not measured: {one['why']}")
            written.write_text(json.dumps(found, indent=1) + "\n", "utf-8")
            made = table(found, options.patience)
            (options.out / "peers.md").write_text(made, "utf-8")
            if options.page:
                options.page.write_text(in_place(options.page.read_text("utf-8"), made), "utf-8")


if __name__ == "__main__":
    main()
