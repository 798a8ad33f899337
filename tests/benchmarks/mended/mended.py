"""Mended in one: is what a student is told of a mistake enough to mend it, without knowing the course?

    python tests/benchmarks/mended/mended.py ask DIR     a folder for each: README, wrong module, finding
    python tests/benchmarks/mended/mended.py score DIR   what became of them after one edit each
    python tests/benchmarks/mended/mended.py tell        what each of ``afresh`` is told, as Markdown
    python tests/benchmarks/mended/mended.py rows        what each program of misleading/rows.toml is told

``mistakes/EXERCISE/NAME.py`` holds the definitions that differ from the model solution. They were written
from READMEs, stubs and solutions, not from checks; ``told.md`` says of which functions hypotheses had been
seen, and what each mistake is told. Those in ``afresh`` were written later, from READMEs and stubs. A folder
of ``ask`` says nothing of the mistake but what the course says; ``DIR/manifest.json``, which whoever mends
must not see, says which mistake it is.
"""

from __future__ import annotations

import argparse
import ast
import json
import shutil
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[3]
MISTAKES = Path(__file__).with_name("mistakes")
AFRESH = Path(__file__).with_name("afresh")
ROWS = Path(__file__).with_name("misleading") / "rows.toml"
#: A file that is no UTF-8 says so before any check: it has a row of its own.
LATIN = "# \N{LATIN SMALL LETTER E WITH ACUTE}\n"
sys.path.insert(0, str(ROOT))

from course.authoring.exercises.grading import (  # noqa: E402
    compose,
    grade_sources,
    mistakes_of,
    solution_path,
    source_of,
)
from course.catalog.load import Catalog  # noqa: E402
from course.grading.exports.selection import checks_for_student  # noqa: E402
from course.scoring.verdict import Verdict  # noqa: E402

FATES = ("mended", "more", "not mended")


def joined(solution: Path, mistake: Path) -> str:
    """The model solution with a mistake's definitions in the place of its own, and without its comment.

    What the solution has not got (an import, a helper, a table) goes before the definition that follows it in
    the mistake.
    """
    lines = compose(solution, mistake).decode().splitlines()
    text = solution.read_text(encoding="utf-8").rstrip().splitlines()
    places: dict[str, tuple[int, int]] = {}
    new: list[str] = []
    changes: list[tuple[int, int, list[str]]] = []
    for node in ast.parse("\n".join(lines)).body:
        begin, end = (
            node.lineno - 1 - len(getattr(node, "decorator_list", [])),
            node.end_lineno or node.lineno,
        )
        targets = [*getattr(node, "targets", []), getattr(node, "target", None)]
        names = [getattr(node, "name", None), *(getattr(target, "id", None) for target in targets)]
        if begin < len(text):
            places |= {name: (begin, end) for name in names if name}
        elif found := next((places[name] for name in names if name in places), None):
            changes.append((*found, new + lines[begin:end]))
            new = []
        elif not isinstance(node, ast.Expr):  # its docstring
            new += [*lines[begin:end], ""]
    # From below, so that the lines above stay where they are.
    for begin, end, own in sorted(changes, reverse=True):
        text[begin:end] = own
    return "\n".join(text + new) + "\n"


def wrong_modules(folder: Path) -> dict[str, tuple[str, str]]:
    """Exercise and text of each wrong module of a folder, by exercise and name."""
    catalog, found = Catalog(), {}
    for path in sorted(folder.glob("*/*.py")):
        exercise = catalog.exercise(path.parent.name)
        found[f"{exercise.id}/{path.stem}"] = (exercise.id, joined(solution_path(catalog, exercise), path))
    return found


def graded(sources: dict[str, tuple[str, str]]) -> dict[str, Verdict]:
    """Verdicts of a grading run, by name, on sources by name: exercise and text of each."""
    catalog, names = Catalog(), list(sources)
    entries = [(catalog.exercise(exercise), source.encode()) for exercise, source in sources.values()]
    return {names[index]: verdict for index, verdict in grade_sources(entries, graders=2)}


def points_by_task(verdict: Verdict) -> dict[str, tuple[float, float]]:
    """Points reached and points to be had, of each task; none of a submission that was not graded."""
    tasks = {check.task for check in verdict.checks}
    return {
        task: (
            sum(check.points for check in verdict.checks if check.task == task),
            sum(check.max_points for check in verdict.checks if check.task == task),
        )
        for task in sorted(tasks)
    }


def at_home(exercise: str, module: str, source: str) -> tuple[str, bool]:
    """What ``course check`` prints, and whether a check failed."""
    course = [sys.executable, "-m", "course"]
    with tempfile.TemporaryDirectory() as folder:
        where = {"cwd": folder, "env": {"PATH": "/usr/bin:/bin", "HOME": folder, "PYTHONPATH": str(ROOT)}}
        for words in (("init", "."), ("start", exercise)):
            subprocess.run([*course, *words], check=True, capture_output=True, **where)
        (Path(folder) / exercise / module).write_text(source, encoding="utf-8")
        done = subprocess.run(
            [*course, "check", exercise], check=False, capture_output=True, text=True, **where
        )
    if done.returncode not in {0, 1}:
        raise RuntimeError(done.stdout + done.stderr)
    return done.stdout, done.returncode == 1


def handed_in(verdict: Verdict) -> str:
    """What the page of a grading run says of what failed."""
    failed = [check for check in checks_for_student(verdict) if check.status != "pass"]
    return "\n\n".join(f"{check.title}\n{check.message}\n{check.help}".rstrip() for check in failed) + "\n"


def ask(folder: Path) -> None:
    """Write the folders and the manifest; say which mistakes nobody catches."""
    catalog, sources = Catalog(), wrong_modules(MISTAKES)
    verdicts, manifest, counts = graded(sources), {}, dict[str, int]()
    for name, (exercise_id, source) in sources.items():
        before = points_by_task(verdicts[name])
        wrong = [task for task, (points, most) in before.items() if points < most]
        if verdicts[name].state == "graded" and not wrong:
            print(f"loses no point, left out: {name}")
            continue
        counts[exercise_id] = counts.get(exercise_id, 0) + 1
        exercise = catalog.exercise(exercise_id)
        finding, seen = at_home(exercise_id, exercise.module, source)
        place = folder / f"{exercise_id}-{counts[exercise_id]:02}"
        place.mkdir(parents=True)
        shutil.copy(Path(exercise.folder) / "README.md", place)
        (place / exercise.module).write_text(source, encoding="utf-8")
        (place / "finding.txt").write_text(finding if seen else handed_in(verdicts[name]), encoding="utf-8")
        manifest[place.name] = {
            "mistake": name,
            "exercise": exercise_id,
            "module": exercise.module,
            "hidden": not seen,
            "wrong": wrong,
            "points": sum(points for points, _ in before.values()),
        }
    (folder / "manifest.json").write_text(json.dumps(manifest, indent=1) + "\n", encoding="utf-8")
    hidden = sum(one["hidden"] for one in manifest.values())
    print(f"{len(manifest)} asked, {hidden} of them told by hidden checks alone")


def fate(one: dict[str, Any], verdict: Verdict) -> str:
    """What became of a mistake: full marks for everything; some more of what was wrong; neither."""
    after = points_by_task(verdict)
    if after and all(points >= most for points, most in after.values()):
        return "mended"
    kept = all(points >= most for task, (points, most) in after.items() if task not in one["wrong"])
    return "more" if kept and sum(points for points, _ in after.values()) > one["points"] else "not mended"


def score(folder: Path) -> None:
    """Print what became of each mistake, by exercise; the last column is for whoever reads the findings."""
    manifest = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
    sources = {
        name: (one["exercise"], (folder / name / one["module"]).read_text(encoding="utf-8"))
        for name, one in manifest.items()
    }
    verdicts = graded(sources)
    fates = {name: fate(one, verdicts[name]) for name, one in manifest.items()}
    print("| exercise | asked | mended | same function passes more | not mended |\n|---|---|---|---|---|")
    exercises = sorted({one["exercise"] for one in manifest.values()})
    for exercise in [*exercises, "all"]:
        own = [fates[name] for name, one in manifest.items() if exercise in {one["exercise"], "all"}]
        print("|", " | ".join([exercise, str(len(own)), *(str(own.count(kind)) for kind in FATES)]), "|")
    print("\n| folder | mistake | told | became | finding true |\n|---|---|---|---|---|")
    for name, one in manifest.items():
        told = "hidden" if one["hidden"] else "at home"
        print(f"| {name} | {one['mistake']} | {told} | {fates[name]} | |")
    print("\nNot mended:", ", ".join(n for n, kind in fates.items() if kind != "mended") or "none")


def told(verdict: Verdict) -> list[str]:
    """Each thing that is said of what failed, once: at home, or by hidden checks if nothing fails at home."""
    if verdict.error:
        return [f"{verdict.error.message} {verdict.error.help}"]
    failed = [check for check in checks_for_student(verdict) if check.status not in {"pass", "skip"}]
    seen = [check for check in failed if check.visibility == "public"] or failed
    return list(dict.fromkeys(f"{check.message} {check.help}" for check in seen))


def tell() -> None:
    """Print what each mistake of ``afresh`` is told."""
    for name, verdict in sorted(graded(wrong_modules(AFRESH)).items()):
        print(f"**{name}**\n")
        print("".join(f"- {line}\n" for line in told(verdict) or ["loses no point"]))


def rows() -> None:
    """Print what the programs of every row are told now, verbatim."""
    catalog, table = Catalog(), tomllib.loads(ROWS.read_text(encoding="utf-8"))["row"]
    sources = {}
    for program in {program for row in table for program in row["programs"]}:
        exercise_id, name = program.split(": ")
        exercise = catalog.exercise(exercise_id)
        known = {one.name: one for one in mistakes_of(catalog, exercise).wrong}
        if name in known:
            source = source_of(catalog, exercise, known[name])
        else:
            source = compose(solution_path(catalog, exercise), ROOT / name)
        sources[program] = (exercise_id, source.decode())
    verdicts = graded(sources)
    first = next(iter(catalog.exercises()))
    latin_1 = LATIN.encode("latin-1") + solution_path(catalog, first).read_bytes()
    ((_, latin),) = grade_sources([(first, latin_1)], graders=1)
    print(
        "# What once misled\n\nWhat was done, what version 1.2.0 said of it, and what is said now, verbatim."
    )
    print("Written by `tests/benchmarks/mended/mended.py rows`.\n")
    print("## a latin-1 byte in a comment\n\nWas told: Was something else saved under its name?\n")
    print("".join(f"- {line}\n" for line in told(latin)))
    for row in table:
        print(f"## {row['did']}\n\nWas told: {row['was']}\n")
        for program in row["programs"]:
            name = program.partition(": ")[2]
            print(f"`{Path(name).stem if name.endswith('.py') else name}`\n")
            print("".join(f"- {line}\n" for line in told(verdicts[program]) or ["loses no point"]))


def main() -> None:
    """Ask, score, or tell."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    verbs = {"ask": ask, "score": score, "tell": tell, "rows": rows}
    parser.add_argument("verb", choices=tuple(verbs))
    parser.add_argument("folder", type=Path, metavar="DIR", nargs="?")
    given = parser.parse_args()
    if (given.folder is None) != (given.verb in {"tell", "rows"}):
        parser.error("ask and score take a folder, tell and rows do not")
    verbs[given.verb](*[given.folder] * (given.folder is not None))


if __name__ == "__main__":
    main()
