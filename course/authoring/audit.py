"""The course checks itself.

``audit`` reads every lesson and exercise and grades what must pass and what must fail. It reports all
problems at once, so that an author can work through a list.
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Collection
from pathlib import Path

from course.authoring.coverage import IsCommand, audit_coverage
from course.authoring.exercises.diagnosis import audit_diagnoses
from course.authoring.exercises.files import audit_files, blanks_in, find_blanks
from course.authoring.exercises.grading import GradeSources, declared_checks, grade_sources, solutions_folder
from course.authoring.exercises.proofs import Proof, Prover, caught_by, plan
from course.authoring.exercises.source import audit_style
from course.authoring.lessons.lint import (
    LinkChecker,
    Refused,
    audit_figures,
    audit_lesson,
    audit_listed,
    audit_objective,
    audit_syllabus,
)
from course.authoring.report import AuditReport, Findings, Progress
from course.catalog.load import Catalog
from course.catalog.markdown import YEAR, read_task
from course.catalog.models import Exercise
from course.catalog.questions import Question, read_questions
from course.catalog.reading import Document, LineMap, read_text
from course.errors import ContentError, NotFoundError
from course.ids import WARM_UPS
from course.printable import counted
from course.quizzing.desk import faults_in
from course.sandbox.runs.running import run
from course.sandbox.scene.loading import (
    read_scene,
    scene_folders,
    scene_ids,
    scene_path,
    unchanged,
    unsaid,
    values_of,
)
from course.sandbox.scene.model import Scene

# ---
# The audit of the quiz: every question, every variant, every case its numbers can take.


#: With fewer, a retake is likely to repeat a question that was just explained.
LEAST_VARIANTS = 4

#: The id under which a gradebook keeps the quiz.
_TAKEN = "quiz"


def audit_quiz(catalog: Catalog, findings: Findings, only: str | None = None) -> tuple[str, ...]:
    """Check the questions; returns their ids.

    Args:
        only: id of one question; None for all.
    """
    folder = catalog.content.quiz
    blank = [path for path in sorted(folder.glob("*.toml")) if blanks_in(path, findings)]
    if (catalog.content.exercises / _TAKEN).is_dir():
        problem = "an exercise is called quiz, and that is what gradebooks call the quiz."
        findings.add(catalog.content.exercises / _TAKEN, None, "quiz", problem, "Rename the exercise.")
    if blank:
        return tuple(path.stem for path in blank)
    try:
        documents = read_questions(folder)
    except ContentError as error:
        findings.add_error(error)
        return (error.file.stem,)
    chosen = [document for document in documents if only in (None, document.value.id)]
    for document in chosen:
        _audit_question(catalog, document, findings)
    return tuple(document.value.id for document in chosen)


def _audit_question(catalog: Catalog, document: Document[Question], findings: Findings) -> None:
    question, wrong = document.value, findings.about(document.path, document.lines, "quiz")
    if len(question.variant) < LEAST_VARIANTS:
        number = counted(len(question.variant), "variant")
        problem = f"question {question.id} has {number}, and needs {LEAST_VARIANTS}."
        wrong((), problem, "Add variants: new numbers or a new situation for the same idea.")
    if question.lesson:
        LinkChecker(catalog, findings).check_question(document)
    used = {option.misconception for variant in question.variant for option in variant.option}
    for name in question.misconceptions:
        if name not in used:
            problem = f"no option is tied to the misconception {name}."
            wrong(("misconceptions", name), problem, "Tie a wrong option to it, or remove it.")
    for index, variant in enumerate(question.variant):
        if not YEAR.search(variant.source) and not any(number.formula for number in variant.number):
            problem = f"the source of variant {variant.id} has no date."
            wrong(("variant", index, "source"), problem, "Name who says so and in which year.")
    for fault in faults_in(document):
        findings.add(document.path, fault.line, "quiz", fault.problem, fault.help)


def audit(
    catalog: Catalog,
    only: str | None = None,
    *,
    without: Collection[str] = (),
    on_progress: Progress | None = None,
    grade: GradeSources = grade_sources,
    refused: Refused | None = None,
    is_command: IsCommand | None = None,
) -> AuditReport:
    """Check the course, or one lesson or exercise of it.

    Args:
        only: id of a lesson, an exercise, a question or a scene; None for everything.
        without: ids of lessons and exercises to leave out, where each is checked by itself.
        on_progress: called at the start and after each submission with the number graded and the total.
        grade: gives the verdicts on submissions. It may leave some out: they are not counted, and fields
            that hints name are not looked for.
        is_command: whether ``course`` followed by these words is a command, for docs/coverage.md; None to
            leave that page out.

    Raises:
        MissingCapabilityError: this installation has no solutions or no hidden graders.
        NotFoundError: there is nothing with the id ``only``.
    """
    started = time.monotonic()
    catalog.content.instructors()
    findings = Findings(catalog.content.root)
    try:
        chosen = _chosen(catalog, only)
        lessons, exercises = (tuple(one for one in ids if one not in without) for ids in chosen)
        if only is None:
            audit_syllabus(catalog, findings)
            if is_command is not None:
                audit_coverage(catalog, is_command, findings)
    except ContentError as error:
        findings.add_error(error)
        return AuditReport(findings.sorted(), seconds=time.monotonic() - started)
    links = LinkChecker(catalog, findings)
    for lesson_id in lessons:
        audit_listed(catalog, lesson_id, findings)
        path = catalog.content.lessons / f"{lesson_id}.md"
        if path.is_file() and not blanks_in(path, findings):
            audit_lesson(catalog, lesson_id, findings, links, refused)
    audit_figures(catalog, None if only is None else lessons, findings)
    questions = audit_quiz(catalog, findings, only) if only in (None, *catalog.question_ids()) else ()
    for question in questions:
        audit_objective(catalog, "quiz", question, findings)
    scenes = _check_scenes(only, findings)
    whole: list[Exercise] = []
    read = [_read(catalog, exercise_id, findings, whole) for exercise_id in exercises]
    audit_style(catalog, whole, findings)
    ready = [one for one in read if one is not None]
    work = [(prover, proof) for prover, proofs in ready for proof in proofs]
    graded, isolation = _grade(work, findings, on_progress, grade)
    return AuditReport(
        problems=findings.sorted(),
        lessons=lessons,
        exercises=exercises,
        questions=questions,
        scenes=scenes,
        checks=sum(len(prover.checks) for prover, _ in ready),
        graded=graded,
        isolation=isolation,
        seconds=time.monotonic() - started,
    )


def _chosen(catalog: Catalog, only: str | None) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Ids of the lessons and exercises to look at; lesson files that nothing lists yet are among them."""
    files = {path.stem for path in catalog.content.lessons.glob("*.md")}
    catalog.warm_up_ids()  # refuses an id that an exercise has, too
    place = catalog.content.exercises
    folders = (_folders_in(place) - {WARM_UPS}) | _folders_in(place / WARM_UPS)
    listed = catalog.lesson_ids()
    lessons = (*listed, *sorted(files - set(listed)))
    exercises = tuple(sorted(folders))
    if only is None:
        return lessons, exercises
    chosen = tuple(i for i in lessons if i == only), tuple(i for i in exercises if i == only)
    others = (*catalog.question_ids(), *scene_ids())
    if not any(chosen) and only not in others:
        raise NotFoundError(
            f"No lesson, exercise, question or scene is called {only[:80]!r}.",
            help=f"Known: {', '.join([*lessons, *exercises, *others])}.",
        )
    return chosen


def _folders_in(folder: Path) -> set[str]:
    if not folder.is_dir():
        return set()
    return {one.name for one in folder.iterdir() if one.is_dir() and not one.name.startswith((".", "__"))}


def _check_scenes(only: str | None, findings: Findings) -> tuple[str, ...]:
    """The sandbox's scenes hold together, the formulas in their texts too; ids of those looked at."""
    names = tuple(name for name in scene_ids() if only in {None, name})
    for name in names:
        path = scene_path(name)
        *_, last = (folder / f"{name}.toml" for folder in scene_folders())
        if last != path and last.is_file():
            problem = f"the program has a scene {name}, which is played instead."
            findings.add(last, None, "content", problem, "Rename the file, and its id.")
        with findings.refusals():
            if not blanks_in(path, findings):
                _check_scene(path, read_scene(path), findings)
    return names


def _check_scene(path: Path, scene: Scene, findings: Findings) -> None:
    """It has a place of its own, asks for a number, and its run gives the one of its theory."""
    wrong = findings.about(path, LineMap(read_text(path)), "scene")
    for name in scene_ids():
        with contextlib.suppress(ContentError):  # reported where that scene is checked
            other = read_scene(scene_path(name))
            if other.id < scene.id and other.order == scene.order:
                problem = f"scene {other.id} has the order {scene.order} too."
                wrong(("order",), problem, "Give each one of its own.")
    where = ("prediction",)
    if scene.prediction is None:
        problem = "it asks for no number before the run."
        wrong(where, problem, "Add [prediction]: docs/sandbox.md describes it.")
        return
    for name in unsaid(scene):
        problem = f"with another {name} the answer is another, and `question` and `why` stay the same."
        wanted = "g" if name == "gravity" else name.replace("-", "_")
        known = [one for one in values_of(unchanged(scene)) if one.rpartition(".")[2] == wanted]
        fix = f"Write in one of them a formula in braces with {' or '.join(known[:3])}."
        wrong(where, problem, fix)
    found = run(unchanged(scene)).comparison
    if found is not None and not found.agree:
        problem = f"theory gives {found.theory:g} {found.unit}, and the run {found.simulation:g}."
        fix = "Correct the formula or the probe, or let `agrees` say how far apart they may be, and why."
        wrong(where, problem, fix)


def _read(
    catalog: Catalog, exercise_id: str, findings: Findings, whole: list[Exercise]
) -> tuple[Prover, tuple[Proof, ...]] | None:
    """Audit the files of an exercise, and plan what is to be graded; None if they are not fit for it.

    Args:
        whole: gets the exercise, if none of its files is missing or is not Python.
    """
    own = Findings(findings.root)
    ready = None
    with own.refusals():
        if not find_blanks(catalog, exercise_id, own):
            exercise = catalog.read_exercise(exercise_id)
            _check_readmes(catalog, exercise, own)
            checks = audit_files(catalog, exercise, own)
            audit_diagnoses(catalog, exercise, own)
            if not exercise.is_warm_up:
                audit_objective(catalog, "exercises", exercise.id, own)
            whole.append(exercise)
            proofs = plan(catalog, exercise, own)
            # Checks that lack a marker would only fail again, all at once and less clearly; and a diagnosis
            # without words breaks its check.
            if not own.of("check", "words"):
                declared_checks(exercise, catalog)
                caught = caught_by(catalog, exercise)
                ready = Prover(exercise, checks, caught, Findings(findings.root)), proofs
    findings.problems += own.problems
    return ready


def _check_readmes(catalog: Catalog, exercise: Exercise, findings: Findings) -> None:
    links = LinkChecker(catalog, findings)
    links.check_readme(exercise.readme_path)
    links.check_reading(exercise.readme_path.with_name("exercise.toml"), exercise)
    if exercise.is_warm_up:
        read_task(exercise.readme_path)  # it is shown inside its lesson
    prose = solutions_folder(catalog, exercise) / "README.md"
    if prose.is_file():
        links.check_readme(prose)


def _grade(
    work: list[tuple[Prover, Proof]],
    findings: Findings,
    on_progress: Progress | None,
    grade: GradeSources,
) -> tuple[int, str]:
    """Grade what was planned; how many submissions got a score, and at which protection level."""
    provers = tuple(dict.fromkeys(prover for prover, _ in work))
    if on_progress:
        on_progress(0, len(work), "")
    done, graded, isolation = 0, 0, ""
    for index, verdict in grade([(prover.exercise, proof.source) for prover, proof in work]):
        done += 1
        prover, proof = work[index]
        prover.judge(proof, verdict)
        graded += verdict.state == "graded"
        isolation = verdict.isolation or isolation
        if on_progress:
            on_progress(done, len(work), f"{prover.exercise.id}: {proof.role} {proof.name}")
        if all(prover.hopeless for prover in provers):
            break
    for prover in provers:
        if done == len(work):  # a field that no check has had may be one of a program that was left out
            prover.judge_hints()
        findings.problems += prover.problems
    return graded, isolation
