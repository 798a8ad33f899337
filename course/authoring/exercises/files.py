"""The audit of an exercise's files, without running any of them.

Blanks left by ``course author new``, hints, README, stub against solution, and the checks' own declarations.
``course.authoring.exercises.proofs`` has the rules that take a grading run.
"""

import ast
import contextlib
import hashlib
import math
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import msgspec

from course.authoring.exercises.grading import (
    accepted_files,
    accepted_sources,
    declared_checks,
    exercise_graders,
    mistakes_of,
    mistakes_path,
    solution_path,
    source_of,
)
from course.authoring.exercises.source import (
    DECIMAL,
    CheckSource,
    checks_in,
    foreign_imports,
    parse,
    quoted_numbers,
    signatures,
    unseeded,
)
from course.authoring.report import About, Findings
from course.catalog.load import Catalog
from course.catalog.models import QUICK, Exercise, Measured, Times
from course.catalog.reading import blanks, read_document, read_text
from course.errors import ContentError
from course.printable import counted
from course.progress.workspace import write_atomically
from course.reading.parts import read_script
from course.scoring.explain.story import read_table
from course.scoring.judging.session import GradingSession
from course.scoring.judging.submission import Submission, Terms

# ---
# The audit of an exercise's checks as declared: titles, markers, points, and the words they show.


def audit_checks(catalog: Catalog, exercise: Exercise, findings: Findings) -> tuple[CheckSource, ...]:
    """Audit the checks of an exercise, public ones first, and return them."""
    checks = declared(catalog, exercise)
    first: dict[str, CheckSource] = {}
    for check in checks:
        if check.id in first:
            other = first[check.id]
            where = f"line {other.line}" if other.path == check.path else other.path.parent.name
            _wrong(findings, check, "exists twice.", f"Rename it; the other is in {where}.")
        first.setdefault(check.id, check)
    for check in checks:
        _audit_check(exercise, check, first, findings)
    _audit_words(exercise, exercise_graders(catalog, exercise), findings)
    return checks


def declared(catalog: Catalog, exercise: Exercise) -> tuple[CheckSource, ...]:
    """The checks of an exercise with their markers, public ones first."""
    public, hidden = exercise.checks_path, exercise_graders(catalog, exercise) / "checks.py"
    checks = tuple(checks_in(public, parse(public), hidden=False))
    if hidden.is_file() or not exercise.is_warm_up:
        checks += tuple(checks_in(hidden, parse(hidden), hidden=True))
    return _with_computed_marks(catalog, exercise, checks)


def _with_computed_marks(
    catalog: Catalog, exercise: Exercise, checks: tuple[CheckSource, ...]
) -> tuple[CheckSource, ...]:
    """Ask pytest for the values of markers that are not plain values in the source.

    Not while a check lacks a marker or its docstring: then nothing can be collected, and that is reported.
    """
    complete = all(
        check.title
        and (check.task is not None or "task" in check.indirect)
        and (check.points is not None or "points" in check.indirect)
        for check in checks
    )
    if not complete or not any(check.indirect for check in checks):
        return checks
    known = declared_checks(exercise, catalog)
    return tuple(
        replace(check, task=found.task, points=found.points, requires=found.requires)
        if (found := known.get(check.id))
        else check
        for check in checks
    )


def _audit_check(
    exercise: Exercise, check: CheckSource, known: dict[str, CheckSource], findings: Findings
) -> None:
    """One check: its docstring, its markers, and what it depends on."""
    if not check.title:
        fix = "Start the function with a docstring of one line: what is true of right code."
        _wrong(findings, check, "has no title.", fix)
    if check.task is None:
        if "task" not in check.indirect:
            _wrong(findings, check, "has no task.", 'Mark it: @pytest.mark.task("name of the function").')
    elif check.task not in {task.id for task in exercise.task}:
        _wrong(
            findings, check, f"belongs to a task {check.task!r} that does not exist.", "Correct the marker."
        )
    if check.points is None:
        if "points" not in check.indirect:
            _wrong(findings, check, "has no points.", "Mark it: @pytest.mark.points(2).")
    elif not (check.points >= 0 and math.isfinite(check.points)):
        _wrong(findings, check, "has no points that could be added up.", "Give it a number, 0 or more.")
    for required in check.requires:
        if required not in known:
            _wrong(findings, check, f"requires {required!r}, which is not a check.", "Correct the marker.")
        elif known[required].hidden and not check.hidden:
            fix = "Let it depend on public checks alone: a student has no others."
            _wrong(findings, check, f"is public and requires the hidden check {required}.", fix)
    if check.id in _needed_for(check.requires, known):
        _wrong(findings, check, "requires itself, by way of others.", "Remove one of the markers.")


def _needed_for(ids: Iterable[str], known: dict[str, CheckSource]) -> set[str]:
    """Every check that must pass first, directly or indirectly."""
    needed: set[str] = set()
    left = list(ids)
    while left:
        name = left.pop()
        if name in known and name not in needed:
            needed.add(name)
            left += known[name].requires
    return needed


#: What to do about a value that a hidden check shows.
IN_WORDS = "Say it in words; put values into input, expected and actual, which are not shown."


def _audit_words(exercise: Exercise, graders: Path, findings: Findings) -> None:
    """The words of hidden checks contain no decimal number, unless the student already has it in a file.

    And what they draw, a regrade draws again.
    """
    public = public_numbers(exercise)
    for path in sorted(graders.glob("*.py")):
        for line, number in quoted_numbers(parse(path)):
            if number not in public:
                problem = f"a text that a hidden check shows contains the number {number}."
                findings.add(path, line, "leak", problem, IN_WORDS)
        for line, call in unseeded(parse(path)):
            fix = "Take `rng` as an argument of the check: what it draws, `grade rerun` draws again."
            findings.add(path, line, "draw", f"{call} draws other numbers in every run.", fix)


def public_numbers(exercise: Exercise) -> frozenset[str]:
    """Decimal numbers in the student's files: showing them reveals nothing."""
    files = [path for path in exercise.stub_path.parent.rglob("*") if path.suffix in {".py", ".md", ".toml"}]
    table = read_table(exercise.readme_path.parent)
    words = [f"{one.looks_like} {one.advice}" for one in table.words.values()] if table else []
    texts = [*map(read_text, files), *words]
    return frozenset(match[0] for text in texts for match in DECIMAL.finditer(text))


def _wrong(findings: Findings, check: CheckSource, message: str, fix: str) -> None:
    findings.add(check.path, check.line, "check", f"check {check.id} {message}", fix)


# ---
# Sums over the checks of an exercise: written into ``exercise.toml``, and refused there when stale.
#
# A student's wheel has no hidden checks, so their number and points are data there. They are computed from
# the markers of the checks, which say what each is worth.


#: Decimals that are written: sums of markers such as 0.1 are exact to far more.
_DIGITS = 9


@dataclass(frozen=True, slots=True)
class _Sum:
    """A number of ``exercise.toml`` that follows from the checks.

    Attributes:
        where: its key, as steps from the top of the file.
        about: its meaning, in words.
        written, due: the value in the file, and the sum over the checks.
    """

    where: tuple[str | int, ...]
    about: str
    written: float
    due: float

    @property
    def stale(self) -> bool:
        """Whether another number is due."""
        return round(self.written - self.due, _DIGITS) != 0


def _sums(exercise: Exercise, checks: tuple[CheckSource, ...]) -> Iterator[_Sum]:
    hidden = [check for check in checks if check.hidden]
    yield _Sum(("hidden_checks",), "the hidden checks", exercise.hidden_checks, len(hidden))
    points = sum(check.points or 0.0 for check in hidden)
    yield _Sum(("hidden_points",), "the points of the hidden checks", exercise.hidden_points, points)
    for index, task in enumerate(exercise.task):
        points = sum(check.points or 0.0 for check in checks if check.task == task.id)
        about = f"the points of task {task.id}, public and hidden,"
        yield _Sum(("task", index, "points"), about, task.points, points)


def audit_points(exercise: Exercise, checks: tuple[CheckSource, ...], findings: Findings) -> None:
    """Report each number that differs from the sum over the checks."""
    wrong = _declaration(exercise, "points", findings)
    for one in _sums(exercise, checks):
        if one.where[0] == "task" and not one.due:
            task = exercise.task[int(one.where[1])].id
            fix = "Mark a check of it: @pytest.mark.points(2)."
            wrong(one.where, f"no check gives task {task} a point.", fix)
        elif one.stale:
            message = f"{one.about} come to {one.due:g}, and {one.written:g} is written here."
            wrong(one.where, message, f"Run `course author build {exercise.id}`.")


def _declaration(exercise: Exercise, code: str, findings: Findings) -> About:
    """Notes problems of one kind with the values of ``exercise.toml``."""
    path = exercise.checks_path.with_name("exercise.toml")
    return findings.about(path, read_document(path, Exercise).lines, code)


def write_points(catalog: Catalog, exercise: Exercise) -> Path | None:
    """Write the sums over the checks; None if they are there already."""
    path = exercise.checks_path.with_name("exercise.toml")
    lines = read_document(path, Exercise).lines
    text = read_text(path).split("\n")
    stale = [
        one
        for one in _sums(exercise, declared(catalog, exercise))
        if one.stale and (one.due or one.where[0] != "task")
    ]
    # From the bottom up, so that a line that is put in moves none that is still to be changed.
    for one in sorted(stale, key=lambda one: lines.line(one.where), reverse=True):
        key, at = str(one.where[-1]), lines.line(one.where) - 1
        line = f"{key} = {round(one.due, _DIGITS):.{_DIGITS}g}"
        if re.match(rf"\s*{key}\s*=", text[at]):
            text[at] = re.sub(r"[^#]*?(?=\s*(#|$))", line, text[at], count=1)
        else:
            # It was left out: the last line above the first task.
            last = next(i for i in range(lines.line(("task",)) - 2, 0, -1) if text[i].strip())
            text.insert(last + 1, line)
    if not stale:
        return None
    write_atomically(path, "\n".join(text).encode())
    return path


# ---
# How long the slow public checks of an exercise take, measured and written into ``times.json``.
#
# It determines how long ``course check`` waits for a function that may hang; see ``Exercise.patience``. Times
# differ from run to run, so an exercise is measured again only when a file that decides about them changes.


#: A number is replaced once a check takes longer, or less than this share of it: times vary by two.
_LEAST = 0.4


def audit_slow(
    catalog: Catalog, exercise: Exercise, checks: tuple[CheckSource, ...], findings: Findings
) -> None:
    """Report times of checks that do not exist."""
    again = f"Run `course author build {exercise.id}`."
    known = {check.id for check in checks if not check.hidden}
    for check in sorted(exercise.slow.keys() - known):
        findings.add(catalog.times_path, None, "slow", f"there is no public check {check}.", again)


def _decides(catalog: Catalog, exercise: Exercise) -> str:
    """A digest of the files on which the times of public checks depend."""
    solution = solution_path(catalog, exercise)
    files = {*exercise.readme_path.parent.rglob("*.py"), *solution.parent.glob("*.py")}
    files -= {mistakes_path(catalog, exercise)}
    files |= {*accepted_files(catalog, exercise)}
    return digest_of(sorted(files - {exercise.stub_path}))


def digest_of(paths: Iterable[Path], begin: bytes = b"") -> str:
    """A digest of files, of those that are there."""
    made_from = hashlib.sha256(begin)
    for path in paths:
        if path.is_file():
            made_from.update(path.name.encode() + b"\0" + path.read_bytes() + b"\0")
    return made_from.hexdigest()[:16]


def measured(catalog: Catalog, exercise: Exercise) -> dict[str, float]:
    """The most CPU time that each public check takes of a right solution, in s."""
    solution, most = solution_path(catalog, exercise), dict[str, float]()
    sources = [solution.read_bytes(), *accepted_sources(catalog, exercise).values()]
    with GradingSession(exercise, catalog, terms=Terms(timeout=60.0)) as session:
        for source in sources:
            session.grade(Submission({exercise.module: source}))
            for check, seconds in session.took.items():
                most[check] = max(seconds, most.get(check, 0.0))
    return most


def due(written: dict[str, float], most: dict[str, float]) -> dict[str, float]:
    """The value to write, from the present and the measured one: in tenths, rounded up."""
    kept = {check: old for check, old in written.items() if _LEAST * old <= most.get(check, 0.0) <= old}
    slow = {check: math.ceil(10 * seconds) / 10 for check, seconds in most.items() if seconds > QUICK}
    return dict(sorted({**slow, **kept}.items()))


def write_times(catalog: Catalog, exercises: Iterable[Exercise]) -> Path | None:
    """Measure the exercises whose files changed, and write their times; None if none did."""
    known = dict(catalog.times.exercises)
    for exercise in exercises:
        now, before = _decides(catalog, exercise), known.get(exercise.id)
        if before is None or before.made_from != now:
            slow = due(exercise.slow, measured(catalog, exercise))
            known[exercise.id] = Measured(made_from=now, slow=slow)
    there = {*catalog.exercise_ids(), *catalog.warm_up_ids()}
    kept = {name: known[name] for name in sorted(there & known.keys())}
    if kept == catalog.times.exercises:
        return None
    data = msgspec.json.format(msgspec.json.encode(Times(exercises=kept)), indent=1)
    write_atomically(catalog.times_path, data + b"\n")
    return catalog.times_path


#: Mildest first; the last may nearly be the solution.
LEAST_HINTS = 3
LEAST_HINTS_OF_WARM_UP = 2

_TEXT_SUFFIXES = {".py", ".toml", ".md"}


def find_blanks(catalog: Catalog, exercise_id: str, findings: Findings) -> bool:
    """Report each blank that is left in the folders of an exercise; True if there is one."""
    found, place = False, catalog.content.place_of(exercise_id)
    for folder in (catalog.content.exercises, *catalog.content.instructors()):
        for path in sorted((folder / place).rglob("*")):
            if path.suffix in _TEXT_SUFFIXES and path.is_file():
                found = blanks_in(path, findings) or found
    return found


def blanks_in(path: Path, findings: Findings) -> bool:
    """Report the blanks of one file; True if there is one."""
    found = list(blanks(path))
    for number, problem in found:
        findings.add(path, number, "blank", problem, "Replace the whole marker.")
    return bool(found)


def audit_files(catalog: Catalog, exercise: Exercise, findings: Findings) -> tuple[CheckSource, ...]:
    """Everything that reading can show; returns the checks the exercise declares."""
    _audit_declaration(catalog, exercise, findings)
    _audit_hints(catalog, exercise, findings)
    catalog.rubric(exercise)
    _audit_code(catalog, exercise, findings)
    checks = audit_checks(catalog, exercise, findings)
    # Checks without a marker cannot be added up, and are reported.
    if not findings.of("check"):
        audit_points(exercise, checks, findings)
        audit_slow(catalog, exercise, checks, findings)
    return checks


def _audit_declaration(catalog: Catalog, exercise: Exercise, findings: Findings) -> None:
    """The lesson exists and names the exercise; no other exercise claims the same place.

    A warm-up names its lesson and the section it follows instead, so that a lesson need not list them.
    """
    wrong = _declaration(exercise, "exercise", findings)
    if exercise.lesson not in catalog.lesson_ids():
        fix = f"Known: {', '.join(catalog.lesson_ids())}."
        wrong(("lesson",), f"there is no lesson {exercise.lesson}.", fix)
    elif exercise.is_warm_up:
        _audit_section(catalog, exercise, wrong)
    elif exercise.id not in catalog.lesson(exercise.lesson).exercises:
        fix = f'Add "{exercise.id}" to `exercises` in the head of {exercise.lesson}.md.'
        wrong(("lesson",), f"lesson {exercise.lesson} does not name this exercise.", fix)
    _audit_order(catalog, exercise, wrong)
    for other in _readable(catalog, (*catalog.exercise_ids(), *catalog.warm_up_ids())):
        if other.id >= exercise.id:
            continue
        for key, same, what in (
            ("order", other.kind == exercise.kind and _rank(other) == _rank(exercise), "place"),
            ("number", other.number == exercise.number != 0, "number"),
            ("module", other.module == exercise.module, "file"),
        ):
            if same:
                problem = f"{other.kind} {other.id} has the {key} {getattr(exercise, key)} too."
                wrong((key,), problem, f"Give each a {what} of its own.")


def _audit_section(catalog: Catalog, exercise: Exercise, wrong: About) -> None:
    """The section that a warm-up follows is one of its lesson."""
    if not exercise.after:
        return
    known = [section.slug for section in read_script(catalog.lesson(exercise.lesson)).sections]
    if exercise.after not in known:
        problem = f"lesson {exercise.lesson} has no section {exercise.after!r}."
        wrong(("after",), problem, f"Known: {', '.join(known)}.")


def _rank(exercise: Exercise) -> tuple[str, int]:
    """Its place in lists: exercises are counted through, warm-ups by lesson."""
    return (exercise.lesson if exercise.is_warm_up else "", exercise.order)


def _audit_order(catalog: Catalog, exercise: Exercise, wrong: About) -> None:
    """Exercises are in the order in which the lessons lead to them, warm-ups in that of their sections."""
    lessons = catalog.lesson_ids()
    if exercise.lesson not in lessons:
        return
    if exercise.is_warm_up:
        what, ids = "section", catalog.warm_up_ids()
        places = [part.slug for part in read_script(catalog.lesson(exercise.lesson)).sections] + [""]
    else:
        what, ids, places = "lesson", catalog.exercise_ids(), list(lessons)

    def stands(one: Exercise) -> str:
        return one.after if one.is_warm_up else one.lesson

    if stands(exercise) not in places:  # named already
        return
    later = places[places.index(stands(exercise)) + 1 :]
    above = [
        other
        for other in _readable(catalog, ids)
        if other.order < exercise.order and stands(other) in later
        if other.lesson == exercise.lesson or not exercise.is_warm_up
    ]
    if above:
        other = min(above, key=lambda one: one.order)  # where it belongs
        problem = f"{other.kind} {other.id} has a lower order, {other.order}, and its {what} comes later."
        fix = f"Give it the order {other.order}, and each {exercise.kind} from {other.id} on one more."
        wrong(("order",), problem, fix)


def _readable(catalog: Catalog, ids: Iterable[str]) -> Iterator[Exercise]:
    for exercise_id in ids:
        with contextlib.suppress(ContentError):  # reported where that exercise is audited
            yield catalog.exercise(exercise_id)


def _audit_hints(catalog: Catalog, exercise: Exercise, findings: Findings) -> None:
    wrong = _declaration(exercise, "hints", findings)
    least = LEAST_HINTS_OF_WARM_UP if exercise.is_warm_up else LEAST_HINTS
    known = mistakes_of(catalog, exercise).words.keys()
    for index, task in enumerate(exercise.task):
        if len(task.hints) < least:
            where = ("task", index, "hints") if task.hints else ("task", index, "id")
            message = f"task {task.id} has {counted(len(task.hints), 'hint')}, and needs {least}."
            wrong(where, message, "Add hints, mildest first.")
        told = {code for codes in task.fits.values() for code in codes}
        for code in sorted(told - known if known else ()):
            message = f"there are no words for the diagnosis {code}."
            wrong(("task", index, "fits"), message, "A hint can only follow a diagnosis that there is.")


def _audit_code(catalog: Catalog, exercise: Exercise, findings: Findings) -> None:
    """Stub, solution and README have the same functions."""
    solution = solution_path(catalog, exercise)
    stub, model = parse(exercise.stub_path), parse(solution)
    theirs, ours = signatures(stub), signatures(model)
    readme = " ".join(read_text(exercise.readme_path).split())
    for task in exercise.task:
        if task.id not in theirs:
            problem = f"the stub has no function {task.id}, and a task is called so."
            fix = "Add the function, or correct the id of the task."
            findings.add(exercise.stub_path, None, "stub", problem, fix)
    for node in stub.body:
        if isinstance(node, ast.FunctionDef) and not ast.get_docstring(node):
            fix = "Say there what it gives, with shapes and units of arguments and result."
            findings.add(exercise.stub_path, node.lineno, "stub", f"{node.name} has no docstring.", fix)
    for name, signature in theirs.items():
        if name not in ours:
            problem = f"the model solution has no function {name}."
            findings.add(solution, None, "signature", problem, f"Define {signature.text}.")
        elif ours[name].text != signature.text:
            problem = f"the stub has {signature.text}, the solution {ours[name].text}."
            findings.add(solution, ours[name].line, "signature", problem, "Make the two the same.")
        if signature.text not in readme and signature.annotated not in readme:
            problem = f"the README does not show the signature {signature.text}."
            fix = "Write it there as it stands in the stub, with shapes and units."
            findings.add(exercise.readme_path, None, "readme", problem, fix)
    _audit_imports(exercise, exercise.stub_path, stub, findings)
    _audit_imports(exercise, solution, model, findings)
    if not exercise.is_warm_up:
        _audit_length(exercise, findings)
    for path in accepted_files(catalog, exercise):
        _audit_imports(exercise, path, parse(path), findings)
    mistakes, file = mistakes_of(catalog, exercise), mistakes_path(catalog, exercise)
    for variant in (*mistakes.wrong, *mistakes.right):
        with contextlib.suppress(ContentError):  # told where it is planned
            tree = ast.parse(source_of(catalog, exercise, variant))
            _audit_imports(exercise, file, tree, findings, variant.line)


#: In words: of a README what is read before the work begins, and what is looked up beside it. At 150 words a
#: minute it is six minutes; `digital-twin` has seven devices to explain.
_TO_READ, _TO_LOOK_UP, _MORE_TO_READ = 900, 500, {"digital-twin": 1100}
#: And the words in which the first function to write has to come.
_TO_BEGIN = 200


def _audit_length(exercise: Exercise, findings: Findings) -> None:
    """A README is short, and begins with something to write."""
    reading, found, looked_up = read_text(exercise.readme_path).partition("\n## What is checked\n")
    if not found:
        problem = "the README has no section `## What is checked`."
        fix = "Put there what is looked up beside the work; before it stands what is read first."
        findings.add(exercise.readme_path, None, "readme", problem, fix)
        return
    most = _MORE_TO_READ.get(exercise.id, _TO_READ)
    for words, limit, where in (
        (reading.split(), most, "before *What is checked*"),
        (looked_up.split(), _TO_LOOK_UP, "below it"),
    ):
        if len(words) > limit:
            problem = f"the README has {len(words)} words {where}, and at most {limit} are allowed."
            findings.add(exercise.readme_path, None, "readme", problem, "Shorten it, or let the stub say it.")
    begins = " ".join(reading.split()[:_TO_BEGIN])
    if not any(f"`{task.id}" in begins for task in exercise.task):
        problem = f"the README names no function in its first {_TO_BEGIN} words."
        findings.add(exercise.readme_path, None, "readme", problem, "Say which one to write first.")


def _audit_imports(
    exercise: Exercise, path: Path, tree: ast.Module, findings: Findings, at: int | None = None
) -> None:
    fix = "Use the standard library and what `imports` in exercise.toml lists."
    for line, name in foreign_imports(tree, exercise.imports):
        findings.add(path, at or line, "imports", f"{name} may not be imported here.", fix)
