"""The proofs that need grading: the stub fails, the solution and its variants pass, each mutant is caught.

Every submission is graded with all checks, as in a grading run. A wrong verdict becomes a problem at the
file, and where possible the line, that an author would open first. A mutant is caught as on record: by that
check, under its own name, and only there.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import msgspec

from course.authoring.exercises.files import IN_WORDS, public_numbers
from course.authoring.exercises.grading import (
    accepted_files,
    compose,
    grade_sources,
    mistakes_of,
    mistakes_path,
    solution_path,
    solutions_folder,
    source_of,
)
from course.authoring.exercises.source import DECIMAL, CheckSource, parse, signatures
from course.authoring.mistakes import Mistakes, Variant
from course.authoring.report import AuthorProblem, Findings, Progress
from course.catalog.load import Catalog
from course.catalog.models import Exercise, fields_of
from course.catalog.reading import read_document, read_text
from course.errors import ContentError
from course.handed_in.attempts import numbers_of
from course.progress.history import NO_MISTAKE
from course.progress.workspace import write_atomically
from course.scoring.failures import ON_THE_MODEL
from course.scoring.graders import LEFT_OUT
from course.scoring.judging.outcomes import NOT_JUDGED
from course.scoring.values import leaves
from course.scoring.verdict import OURS, CheckResult, Status, Verdict, Visibility

_INTEGER = re.compile(r"(?<![\w.])-?\d+(?![\w.]*\w)")
#: Of an exercise of n functions: n + 1 unusual solutions that must pass, and this many wrong ones times n.
MUTANTS_EACH = 4
#: The same of a warm-up, however many functions it has.
LEAST_OF_WARM_UP = 2, 3
#: Smaller whole numbers are words: "two arguments", "order 4".
_TELLING = 10


@dataclass(frozen=True, slots=True)
class Proof:
    """One submission to grade and what it must show.

    Attributes:
        role: "stub", "solution", "accepted" or "mutant".
        line: in its file, where that has more than this program.
    """

    role: str
    path: Path
    source: bytes
    name: str
    mutant: Variant | None = None
    line: int | None = None


def plan(catalog: Catalog, exercise: Exercise, findings: Findings) -> tuple[Proof, ...]:
    """The submissions that prove an exercise; a file that cannot be one is reported and left out."""
    solution, file = solution_path(catalog, exercise), mistakes_path(catalog, exercise)
    proofs = [
        Proof(role, path, read_text(path).encode(), path.name)
        for role, path in (("stub", exercise.stub_path), ("solution", solution))
    ]
    mistakes, accepted = mistakes_of(catalog, exercise), accepted_files(catalog, exercise)
    functions = len(exercise.task)
    least, least_mutants = functions + 1, functions * MUTANTS_EACH
    if exercise.is_warm_up:
        least, least_mutants = LEAST_OF_WARM_UP
    if (right := len(accepted) + len(mistakes.right)) < least:
        message = f"accepted variants: {right}, and an exercise of this size has at least {least}."
        fix = "Add correct but unusual code: checks that refuse it are too narrow."
        findings.add(solution.parent / "accepted", None, "accepted", message, fix)
    for path in accepted:
        with findings.refusals():
            proofs.append(Proof("accepted", path, compose(solution, path), path.name))
    for variant in (*mistakes.right, *mistakes.wrong):
        role, mutant = ("mutant", variant) if variant.code else ("accepted", None)
        with findings.refusals():
            source = source_of(catalog, exercise, variant)
            proofs.append(Proof(role, file, source, variant.name, mutant, variant.line))
    if not mistakes.wrong:
        message = "it has no wrong program, so nothing shows that the checks catch anything."
        findings.add(file, None, "mutants", message, "Add the mistakes that students make.")
        return tuple(proofs)
    _audit_mutants(exercise, mistakes, file, findings)
    if len(mistakes.wrong) < least_mutants:
        count = len(mistakes.wrong)
        message = f"mutants: {count}, and an exercise of this size has at least {least_mutants}."
        findings.add(file, None, "mutants", message, "Add the mistakes that students make.")
    if 2 * len({variant.code for variant in mistakes.wrong}) <= len(exercise.task):
        message = "most tasks share their diagnoses, which tell no mistakes apart then."
        findings.add(file, None, "mutants", message, "Give each kind of mistake a code of its own.")
    return tuple(proofs)


def _audit_mutants(exercise: Exercise, mistakes: Mistakes, file: Path, findings: Findings) -> None:
    tasks = {task.id for task in exercise.task}
    for index, variant in enumerate(mistakes.wrong):
        if variant.task not in tasks:
            message = f"{variant.name} is of a task that the exercise does not have."
            findings.add(file, variant.line, "mutants", message, f"Its tasks are {', '.join(sorted(tasks))}.")
        if exercise.is_warm_up and variant.code in {one.code for one in mistakes.wrong[:index]}:
            message = f"another program has the mistake {variant.code}, too."
            fix = "A warm-up tells each of its mistakes apart: give it a code of its own."
            findings.add(file, variant.line, "mutants", message, fix)
    for task in sorted(tasks - {variant.task for variant in mistakes.wrong}):
        message = f"no mutant breaks task {task}, so nothing shows that its checks catch anything."
        findings.add(file, None, "mutants", message, "Add one for each mistake that students make.")


class Prover:
    """Reports every proof of one exercise that its grading does not confirm.

    Attributes:
        checks: by id.
    """

    def __init__(
        self,
        exercise: Exercise,
        checks: tuple[CheckSource, ...],
        caught: Mapping[str, str],
        findings: Findings,
    ) -> None:
        self.exercise = exercise
        self.checks = {check.id: check for check in checks}
        self._caught = caught
        self._findings = findings
        #: A check raised or cannot be imported: what grading says of the programs follows from that.
        self.broken = False
        #: It does so on the model solution: no program can be judged.
        self.hopeless = False
        self._breaks: set[tuple[str, Path, int | None]] = set()
        self._public = public_numbers(exercise)
        self._fields: dict[str, set[str]] = {task.id: set() for task in exercise.task}

    @property
    def problems(self) -> list[AuthorProblem]:
        """What was found; of checks that broke only that they did, since the rest follows from it."""
        return [one for one in self._findings.problems if not self.broken or one.code == "grader"]

    def judge(self, proof: Proof, verdict: Verdict) -> None:
        """Report what is wrong with the verdict on one proof."""
        if self._is_our_fault(proof, verdict):
            return
        if proof.mutant is not None:
            for fault in judge(proof.mutant, self._caught.get(proof.name, ""), verdict):
                text = f"mutant {proof.name} {fault.message}"
                self._findings.add(proof.path, proof.line, "mutant", text, fault.fix)
        elif verdict.state != "graded":
            why = verdict.error.message if verdict.error else verdict.state
            fix = verdict.error.help if verdict.error and verdict.error.help else "Correct the file."
            self._findings.add(proof.path, proof.line, proof.role, f"cannot be graded: {why}", fix)
        elif proof.role == "stub":
            self._judge_stub(proof, verdict)
        else:
            self._judge_correct(proof, verdict)
        for warning in verdict.warnings if proof.mutant is None else ():
            self._findings.add(proof.path, proof.line, proof.role, warning, "Let the whole file load.")
        self._judge_words(verdict)
        for check in verdict.checks:
            self._fields.setdefault(check.task, set()).update(numbers_of(check))

    def judge_hints(self) -> None:
        """Report fields that hints name and that no failed check has had. Call it after the last proof."""
        document = read_document(self.exercise.readme_path.with_name("exercise.toml"), Exercise)
        for index, task in enumerate(() if self.broken else document.value.task):
            for number, sentences in task.yours.items():
                named = frozenset().union(*map(fields_of, sentences))
                for field in sorted(named - self._fields.get(task.id, set())):
                    line = document.lines.line(("task", index, "yours", number))
                    problem = f"no check of {task.id} that a mutant fails has the field {{{field}}}."
                    fix = "A field is an input that a public check names, expected, got, off, ratio or at."
                    self._findings.add(document.path, line, "hints", problem, fix)

    def _is_our_fault(self, proof: Proof, verdict: Verdict) -> bool:
        """Report checks that broke instead of checking, each once, with the line that raised."""
        error = verdict.error
        if error is not None and error.code == "check_file":  # which grader processes could not import
            self.broken = self.hopeless = True
            said, root = _CHECK_FILE.fullmatch(error.message), self._findings.root
            assert said is not None
            line = int(said["line"]) if said["line"] else None
            self._findings.add(root / said["file"], line, "grader", *_told(said["problem"], error.help, root))
            return True
        told = False
        for check in verdict.checks:
            if check.status is Status.GRADER_ERROR:
                told = self.hopeless = True
                self._break(check.id, f"check {check.id} breaks", check.message.removeprefix(ON_THE_MODEL))
            elif (check.traceback or "").startswith(OURS):
                told = True
                what = "" if check.diagnosis == NOT_JUDGED else "the diagnosis of "
                what += f"check {check.id} breaks on {proof.name}"
                self._break(check.id, what, (check.traceback or "").removeprefix(OURS))
        if not told and verdict.state == "grader_error":
            self.broken = True
            why, fix = (error.message, error.help) if error else (verdict.state, "")
            words = f"the checks break on {proof.name}: {why}"
            self._findings.add(self.exercise.checks_path, None, "grader", words, fix or "Correct the checks.")
        return told or verdict.state == "grader_error"

    def _break(self, check: str, what: str, said: str) -> None:
        """Report a check, or its diagnosis, that raised: once, however many programs it raised on."""
        self.broken = True
        path, line = self._place(check, self.exercise.checks_path)
        raised = _RAISED.search(said)
        if raised is not None and (self._findings.root / raised["file"]).is_file():
            path, line = self._findings.root / raised["file"], int(raised["line"])
            said = said[: raised.start()]
            check = ""  # a line that several checks share is named once
        if (check, path, line) in self._breaks:
            return
        self._breaks.add((check, path, line))
        fix = "Look at a value before computing with it: whatever a student's function returns is a finding."
        if re.search(r"NameError|required (keyword-only|positional) argument", said):
            fix = "Correct that line: it breaks whatever the function returns."
        if "there are no words for" in said:
            fix = "Write the code as `mistakes.py` has it, or give it words there."
        problem, fix = _told(f"{what}: {said.rstrip('.')}.", fix, self._findings.root)
        self._findings.add(path, line, "grader", problem, fix)

    def _judge_stub(self, proof: Proof, verdict: Verdict) -> None:
        for check in verdict.checks:
            if check.status is Status.PASS:
                problem = f"the untouched stub passes check {check.id} of task {check.task}."
                fix = "Let the check fail on code that does nothing."
                self._findings.add(*self._place(check.id, proof.path), "stub", problem, fix)
        self._judge_handout(proof, verdict)
        for task in self.exercise.task:
            if not any(c.task == task.id and c.status is not Status.PASS for c in verdict.checks):
                problem = f"no check of task {task.id} fails on the stub."
                self._findings.add(proof.path, None, "stub", problem, "Give the task a check that does.")

    def _judge_handout(self, proof: Proof, verdict: Verdict) -> None:
        """What public checks find in the stub is unwritten, or declared as its fault."""
        for index, task in enumerate(self.exercise.task):
            told = {
                check.diagnosis
                for check in verdict.checks
                if check.task == task.id and check.visibility is Visibility.PUBLIC and check.diagnosis
            }
            for code in sorted(told - {task.fault, *NO_MISTAKE}):
                told_as = (
                    f"the untouched stub is told {code}, and `course progress` counts that as the student's."
                )
                fix = f'Raise NotImplementedError in {task.id}, or give its task `fault = "{code}"`.'
                self._findings.add(proof.path, self._line_of(proof.path, task.id), "stub", told_as, fix)
            if task.fault and task.fault not in told:
                path = proof.path.with_name("exercise.toml")
                line = read_document(path, Exercise).lines.line(("task", index, "fault"))
                problem = f"no public check tells the untouched stub {task.fault}."
                self._findings.add(path, line, "stub", problem, "Correct the code, or take the line out.")

    def _judge_correct(self, proof: Proof, verdict: Verdict) -> None:
        """Full marks, and the checks that ran are the ones the files declare."""
        for check in verdict.checks:
            if check.status is not Status.PASS:
                line = proof.line or self._line_of(proof.path, check.task)
                problem = f"check {check.id} ends with {check.status}: {check.message or check.blocked_by}"
                problem += f" (expected {check.expected}, got {check.actual})."
                fix = "Correct the code, or the check if the code is right."
                self._findings.add(proof.path, line, proof.role, problem, fix)
        ran = {check.id for check in verdict.checks}
        for check_id in sorted(ran ^ set(self.checks)):
            odd = (
                "ran, but no plain function declares it"
                if check_id in ran
                else "is declared, but did not run"
            )
            place = self._place(check_id, self.exercise.checks_path)
            fix = "Write each check as one top-level function whose name starts with test_."
            self._findings.add(*place, "check", f"check {check_id} {odd}.", fix)
        if not verdict.checks or verdict.score < verdict.max_score or verdict.max_score <= 0:
            message = f"scores {verdict.score:g} of {verdict.max_score:g} points."
            self._findings.add(proof.path, None, proof.role, message, "It must score full marks.")

    def _judge_words(self, verdict: Verdict) -> None:
        """The words of a hidden check contain no value that redaction must hide."""
        for check in verdict.checks:
            if check.visibility is Visibility.HIDDEN and check.status is Status.FAIL:
                for number in _leaks(check, self._public):
                    place = self._place(check.id, self.exercise.checks_path)
                    problem = f"hidden check {check.id} shows the number {number} in its words."
                    self._findings.add(*place, "leak", problem, IN_WORDS)

    def _place(self, check_id: str, otherwise: Path) -> tuple[Path, int | None]:
        check = self.checks.get(check_id)
        return (check.path, check.line) if check else (otherwise, None)

    @staticmethod
    def _line_of(path: Path, task: str) -> int | None:
        """The line a task's function starts on in this file."""
        found = signatures(parse(path)).get(task)
        return found.line if found else None


_CHECK_FILE = re.compile(r"(?P<file>.+?)(?::(?P<line>\d+))?: (?P<problem>.*)", re.DOTALL)
#: The end of what is said of an exception: the course's own file and line that it comes from.
_RAISED = re.compile(r" \((?P<file>[^()]+), line (?P<line>\d+)\)\.?$")
_NOT_THERE = re.compile(r"FileNotFoundError: (?P<file>\S+) is not there")


def _told(problem: str, fix: str, root: Path) -> tuple[str, str]:
    """A problem and its fix, which are others where a file is missing in grader processes alone."""
    absent = _NOT_THERE.search(problem)
    if absent is None or not (root / absent["file"]).exists():
        return problem, fix
    where = f"a grader process does not have {absent['file']}, which is read here."
    left_out = " and ".join(sorted(LEFT_OUT))
    return where, f"Move it: what lies in {left_out} takes no part in grading, and no prose does."


def _leaks(check: CheckResult, public: frozenset[str]) -> Iterator[str]:
    """Numbers in a check's words that reveal something: decimals unknown to students, and its own values."""
    words = f"{check.message} {check.help}"
    for match in DECIMAL.finditer(words):
        if match[0] not in public:
            yield match[0]
    shown = leaves([check.input, check.expected, check.actual])
    values = {float(one) for one in shown if type(one) in {int, float}}
    for match in _INTEGER.finditer(words):
        if abs(int(match[0])) >= _TELLING and float(match[0]) in values:
            yield match[0]


# ---
# Whether each mutant is caught as on record.


@dataclass(frozen=True, slots=True)
class Fault:
    """One unexpected result of a grading."""

    message: str
    fix: str


@dataclass(frozen=True, slots=True)
class MutantOutcome:
    """The outcome for a mutant.

    Attributes:
        check: id of the one that is on record for catching it; "" where none is.
        looks_like: the words of its mistake.
        caught_by: ids of the checks that did not pass, in order.
        by: id of the check that caught it, best under its own name; "" for none.
        diagnosis: the diagnosis of that check, or of the first that caught it; None if it passed.
        message, help: what the student would read there.
        faults: empty if everything is as declared.
    """

    mutant: Variant
    check: str
    looks_like: str
    caught_by: tuple[str, ...]
    by: str
    diagnosis: str | None
    message: str
    help: str
    lost: float
    faults: tuple[Fault, ...]


def run_mutants(
    catalog: Catalog, exercise: Exercise, *, on_progress: Progress | None = None
) -> tuple[MutantOutcome, ...]:
    """Grade every wrong program of an exercise and compare with what is on record."""
    mistakes, caught = mistakes_of(catalog, exercise), caught_by(catalog, exercise)
    sources = [(exercise, source_of(catalog, exercise, variant)) for variant in mistakes.wrong]
    verdicts: dict[int, Verdict] = {}
    if on_progress:
        on_progress(0, len(sources), "")
    for index, verdict in grade_sources(sources):
        verdicts[index] = verdict
        if on_progress:
            on_progress(len(verdicts), len(sources), f"{exercise.id}: {mistakes.wrong[index].name}")
    return tuple(
        outcome_of(variant, caught.get(variant.name, ""), verdicts[index], mistakes)
        for index, variant in enumerate(mistakes.wrong)
    )


def outcome_of(mutant: Variant, check: str, verdict: Verdict, mistakes: Mistakes) -> MutantOutcome:
    """A wrong program and its verdict, compared."""
    by = _result(verdict, check)
    if by is None or by.status is Status.PASS:
        by = _first(mutant, verdict)
    words = mistakes.words.get(mutant.code)
    return MutantOutcome(
        mutant=mutant,
        check=check,
        looks_like=words.looks_like if words else "",
        caught_by=tuple(check.id for check in verdict.checks if check.status is not Status.PASS),
        by=by.id if by else "",
        diagnosis=by.diagnosis if by else None,
        message=by.message if by else "",
        help=by.help if by else "",
        lost=verdict.max_score - verdict.score,
        faults=judge(mutant, check, verdict),
    )


def judge(mutant: Variant, check: str, verdict: Verdict) -> tuple[Fault, ...]:
    """Everything that differs from the program's entry; empty if nothing does.

    Args:
        check: id of the one that is on record for catching it; "" for any, as in a warm-up, which has few.
    """
    if verdict.state != "graded":
        why = verdict.error.message if verdict.error else verdict.state
        return (Fault(f"could not be graded: {why}", "A mutant is wrong code that runs; correct it."),)
    failed = [check for check in verdict.checks if check.status is not Status.PASS]
    if not failed:
        return (Fault("survives: every check passes.", "Sharpen a check, or take it out."),)
    faults = [*_judge_named(mutant, check, _result(verdict, check) if check else _first(mutant, verdict))]
    faults += [
        Fault(
            f"fails check {check.id} of task {check.task}, and should break {mutant.task} only"
            f" ({check.status}: {check.message or check.blocked_by}).",
            "No check and no function of the solution may call another task's. Or narrow the mutant.",
        )
        for check in failed
        if check.task != mutant.task
    ]
    faults += [
        Fault(
            f"breaks the diagnosis of check {check.id}: {check.traceback.removeprefix(OURS)}.",
            "A probe gets whatever a wrong program returns; let it look before it computes.",
        )
        for check in failed
        if check.traceback and check.traceback.startswith(OURS)
    ]
    if all(check.points == check.max_points for check in failed):
        faults.append(Fault("loses no points.", "Give points to the checks that catch it."))
    return tuple(faults)


def _judge_named(mutant: Variant, check: str, named: CheckResult | None) -> tuple[Fault, ...]:
    again = "Sharpen that check, or accept the new record with `course author build --accept`."
    if named is None:
        return (Fault(f"is caught by {check} on record, and there is no such check.", again),)
    if named.task != mutant.task:
        return (Fault(f"is caught by {named.id} on record, which belongs to task {named.task}.", again),)
    if named.status is Status.PASS:
        return (Fault(f"is not caught by {named.id}, as it is on record.", again),)
    if (named.diagnosis or "") not in (mutant.code, *mutant.also):
        said = f"is diagnosed as {named.diagnosis} by {named.id} ({named.status}), not as {mutant.code}."
        fix = "If the two answer alike, ask in questions.py what tells them apart, or give both one code."
        return (Fault(said, f"{fix} Else teach the check's diagnosis, or correct the entry."),)
    return ()


def _result(verdict: Verdict, check_id: str) -> CheckResult | None:
    return next((check for check in verdict.checks if check.id == check_id), None)


def _first(mutant: Variant, verdict: Verdict) -> CheckResult | None:
    """The first check that caught it under its own name, else the first of its task that caught it."""
    failed = [one for one in verdict.checks if one.status is not Status.PASS and one.task == mutant.task]
    codes = (mutant.code, *mutant.also)
    named = (one for one in failed if (one.diagnosis or "") in codes)
    return next(named, failed[0] if failed else None)


# ---
# ``record.json`` beside the solution of an exercise: which check catches each wrong program, and what known
# wrong programs are told. A warm-up has few checks, and no record.


RECORD = "record.json"


class Reported(msgspec.Struct, frozen=True, array_like=True):
    """How often programs with these mistakes get this diagnosis.

    Attributes:
        codes: of the mistakes in them.
        said: diagnosis, "" for none, "survives" where no check fails.
    """

    task: str
    codes: tuple[str, ...]
    said: str
    count: int


class Record(msgspec.Struct, frozen=True, kw_only=True):
    """What came of the wrong programs of an exercise when it was last accepted.

    Attributes:
        made_from: digest of all that the rows follow from.
        caught: the id of the check that catches each program, by its name.
        rows: of all programs, at home ("public"), in a grading run ("full"), and in a run that knows
            no wrong program, where only the checks' probes can name a mistake ("alone").
    """

    made_from: str = ""
    caught: dict[str, str] = {}
    rows: dict[str, tuple[Reported, ...]] = {}


def record_path(catalog: Catalog, exercise: Exercise) -> Path:
    return solutions_folder(catalog, exercise) / RECORD


def read_record(catalog: Catalog, exercise: Exercise) -> Record | None:
    """The record of an exercise; None if it has none.

    Raises:
        ContentError: it is damaged.
    """
    path = record_path(catalog, exercise)
    try:
        return msgspec.json.decode(path.read_bytes(), type=Record) if path.is_file() else None
    except (OSError, msgspec.DecodeError) as error:
        fix = f"Delete the file, then run `course author build {exercise.id} --accept`."
        raise ContentError(path, None, f"it cannot be read: {error}.", help=fix) from None


def write_record(catalog: Catalog, exercise: Exercise, record: Record) -> Path:
    """Write the record beside the solution, one program or row a line."""
    path = record_path(catalog, exercise)
    text = msgspec.json.encode(record).decode().replace("],[", "],\n[").replace('","', '",\n"')
    write_atomically(path, f"{text}\n".encode())
    return path


def caught_by(catalog: Catalog, exercise: Exercise) -> dict[str, str]:
    """The id of the check that catches each wrong program, by its name; empty for a warm-up."""
    record = read_record(catalog, exercise)
    return record.caught if record else {}
