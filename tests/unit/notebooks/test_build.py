"""Generated notebooks: valid, without outputs, the same bytes every time, and nothing Jupyter cannot show."""

import hashlib
import json
import os
import shutil
import subprocess
import sys
import warnings
from pathlib import Path

import msgspec
import nbformat
import pytest

from course.catalog import blocks as b
from course.catalog.markdown import read_blocks
from course.errors import NotFoundError
from course.handed_in.notebook import notebook_source
from course.notebooks.build import FOLDERS, WORKSPACE, exercise_cells, generate, pieces
from course.notebooks.cells import Lowering
from course.notebooks.quiz import SEED, marked
from course.quizzing.bank import Bank

ROOT = Path(__file__).resolve().parents[3]
STRAY = (":::", "{mermaid}", "](lesson:", "](exercise:", "figure:", "](=", "% text:", "{eq}")


@pytest.fixture(scope="module")
def everything(catalog):
    return list(generate(catalog))


def made(everything, kind, name):
    (one,) = [one for one in everything if (one.kind, one.id) == (kind, name)]
    return one


def cells(data, kind=""):
    found = json.loads(data)["cells"]
    return [cell for cell in found if kind in ("", cell["cell_type"])]


def text(cell):
    return "".join(cell["source"])


def test_the_first_cell_of_each_notebook_says_how_to_install_what_it_needs(everything):
    for one in everything:
        first = cells(one.data)[0]
        assert first["cell_type"] == "markdown"
        assert "%pip install" in text(first), one.path


def test_everything_has_a_notebook(catalog, everything):
    paths = [str(one.path) for one in everything]
    expected = [f"lessons/{name}.ipynb" for name in catalog.lesson_ids()]
    expected += [f"exercises/{exercise.id}.ipynb" for exercise in catalog.exercises()]
    assert paths == [*expected, "quiz.ipynb", "sandbox.ipynb"]


def test_an_id_of_a_lesson_and_an_exercise_gives_both(catalog):
    both = set(catalog.lesson_ids()) & set(catalog.exercise_ids())
    assert both
    name = sorted(both)[0]
    assert [one.kind for one in generate(catalog, [name])] == ["lesson", "exercise"]


def test_an_unknown_id_is_refused_with_what_is_close(catalog):
    with pytest.raises(NotFoundError) as caught:
        list(generate(catalog, ["integrator"]))
    assert "integrators" in caught.value.help


def test_notebooks_are_valid_and_have_no_output(everything):
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # nbformat only warns where it repairs ids
        for one in everything:
            read = nbformat.reads
            nbformat.validate(read(one.data.decode(), as_version=nbformat.NO_CONVERT))
    for one in everything:
        ids = [cell["id"] for cell in cells(one.data)]
        slots = [cell["metadata"]["course"]["slot"] for cell in cells(one.data)]
        assert len(set(ids)) == len(ids)
        assert len(set(slots)) == len(slots)
        assert all(cell["outputs"] == [] for cell in cells(one.data, "code"))


def test_nothing_is_left_that_jupyter_would_show_as_stray_text(everything):
    for one in everything:
        for cell in cells(one.data, "markdown"):
            outside = text(cell).split("```")[::2]
            for stray in STRAY:
                assert not any(stray in part for part in outside), (one.path, stray)


def test_a_link_in_a_readme_becomes_the_command_that_opens_it(tmp_path, catalog):
    """A notebook of an exercise may lie in a workspace, a class's folder or anywhere."""
    real = catalog.exercise("integrators")
    shutil.copytree(real.folder, tmp_path / "integrators")
    exercise = msgspec.structs.replace(real, folder=str(tmp_path / "integrators"))
    exercise.readme_path.write_text("See [it](lesson:accuracy#drift), then [that](exercise:collisions).\n")
    first = exercise_cells(exercise, exercise.stub_path.read_text())[0]
    told = first.source.partition("\n\n")[0]
    assert told == "See it (`course lesson accuracy`), then that (`course start collisions`)."


def test_the_functions_of_an_exercise_are_those_of_its_notebook(everything):
    for one in everything:
        if one.kind == "exercise":
            told = "".join(text(cell) for cell in cells(one.data, "markdown"))
            module = one.path.stem.replace("-", "_")
            assert f"from {module} import" not in told
            assert f"in `{module}.py`" not in told
            assert " in this notebook" in told, "its README says nowhere: in `MODULE.py`"


def test_links_between_notebooks_lead_to_notebooks(catalog, everything):
    for whole in (everything, list(generate(catalog, layout=WORKSPACE))):
        lessons = [one for one in whole if one.kind == "lesson"]
        there = {str(one.path) for one in whole}
        links = 0
        for one in lessons:
            for cell in cells(one.data, "markdown"):
                for part in text(cell).split("](")[1:]:
                    address = part.partition(")")[0].partition("#")[0]
                    if address.endswith(".ipynb"):
                        links += 1
                        path = os.path.normpath(os.path.join(str(one.path.parent), address))  # noqa: PTH118
                        assert path in there
        assert links >= 10


def test_a_link_to_a_heading_names_it_as_jupyterlab_does(catalog):
    link = FOLDERS.links(catalog, "digital-twins")
    assert link("lesson:why-simulate#how-it-hangs-together") == "why-simulate.ipynb#How-it-hangs-together"
    assert link("https://example.org/") == "https://example.org/"


def test_an_exercise_has_a_cell_and_a_check_for_each_function_and_stands_for_its_stub(catalog, everything):
    for exercise in catalog.exercises():
        one = made(everything, "exercise", exercise.id)
        tags = [cell["metadata"]["course"] for cell in cells(one.data, "code")]
        for task in exercise.task:
            roles = [tag["role"] for tag in tags if tag.get("task") == task.id]
            assert roles == ["solution", "check"], (exercise.id, task.id)
        given, stood_for = {}, {}
        exec(compile(exercise.stub_path.read_bytes(), "stub", "exec", dont_inherit=True), given)
        exec(
            compile(notebook_source(one.data, exercise).source, "cells", "exec", dont_inherit=True), stood_for
        )
        assert given.keys() - {"__doc__"} == stood_for.keys() - {"__doc__"}


def test_the_stub_is_taken_apart_without_losing_a_line(catalog):
    for exercise in catalog.exercises():
        source = exercise.stub_path.read_text(encoding="utf-8")
        about, parts = pieces(source, {task.id for task in exercise.task})
        assert about
        kept = "\n".join(part.text for part in parts)
        lost = [line for line in source.split('"""', 2)[2].split("\n") if line and line not in kept]
        assert lost == []


def test_a_lesson_keeps_every_block(catalog, everything):
    for lesson in catalog.lessons():
        blocks = read_blocks(catalog.content.lessons / f"{lesson.id}.md")
        one = made(everything, "lesson", lesson.id)
        roles = [cell["metadata"]["course"]["role"] for cell in cells(one.data)]
        assert roles.count("figure") == sum(isinstance(block, b.Figure) for block in blocks)
        assert roles.count("prediction") == sum(isinstance(block, b.Prediction) for block in blocks)
        warm_ups = [cell["metadata"]["course"] for cell in cells(one.data, "code")]
        there = [tags["exercise"] for tags in warm_ups if tags["role"] == "warm-up"]
        assert sorted(there) == sorted(exercise.id for exercise in catalog.warm_ups(lesson.id))
        shown = sum(isinstance(block, b.CodeCell) for block in blocks)
        assert roles.count("lesson") + roles.count("hidden") == shown
        whole = "\n".join(map(text, cells(one.data)))
        assert whole.count("```mermaid") == sum(isinstance(block, b.Diagram) for block in blocks)
        for block in blocks:
            if isinstance(block, b.Paragraph | b.Heading):
                lowered = Lowering(FOLDERS.links(catalog, lesson.id)).block(block)
                assert lowered in whole


def test_characters_with_a_meaning_in_markdown_are_shown_as_they_are():
    lowering = Lowering(str)
    words = b.Paragraph(1, (b.Text("2 * 3 < 4 | a_b [x] $5 `c` \\d"),))
    assert lowering.block(words) == r"2 \* 3 \< 4 \| a\_b \[x\] \$5 \`c\` \\d"


def test_the_quiz_does_not_tell_the_answers_and_marks_them(catalog, everything, capsys):
    one = made(everything, "quiz", "quiz")
    posed = Bank.of(catalog).pose(SEED)
    whole = "\n".join(map(text, cells(one.data)))
    for question in posed:
        assert f'answers["{question.question}"] = ""' in whole
        assert not any(choice.explanation[:40] in whole for choice in question.choices)
        assert all(question.key.id not in text(cell) for cell in cells(one.data, "code"))
    right = {question.question: question.key.letter for question in posed}
    assert marked(SEED, dict.fromkeys(right, "")) is None
    assert "Question 1 is not answered yet." in capsys.readouterr().out
    full = marked(SEED, right)
    assert full.summary.startswith(f"{len(posed)} of {len(posed)} right")
    wrong = marked(SEED, right | {posed[0].question: "abcd".replace(posed[0].key.letter, "")[0]})
    assert f"{len(posed) - 1} of {len(posed)}" in wrong._repr_html_()
    assert posed[0].key.explanation[:40] in repr(wrong)


def test_another_process_writes_the_same_bytes_with_another_hash_seed_and_needs_nothing_of_jupyter(
    everything,
):
    script = (
        "import hashlib, sys\n"
        "from course.catalog.load import Catalog\n"
        "from course.notebooks.build import generate\n"
        "for one in generate(Catalog()): print(one.path, hashlib.sha256(one.data).hexdigest())\n"
        "wrong = {'nbformat', 'nbclient', 'IPython', 'jupyterlab', 'anywidget'} & set(sys.modules)\n"
        "assert not wrong, wrong\n"
    )
    here = "".join(f"{one.path} {hashlib.sha256(one.data).hexdigest()}\n" for one in everything)
    environment = os.environ | {"PYTHONHASHSEED": "4000000000", "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [sys.executable, "-c", script], env=environment, capture_output=True, text=True, check=False
    )
    assert done.stdout == here, done.stderr
    assert done.returncode == 0, done.stderr


def test_the_world_in_a_cell_is_laid_out_by_the_cell_and_not_by_the_window():
    pytest.importorskip("anywidget", reason="the extra `notebook` is not installed")
    from course.notebooks.widgets import style

    css = style()
    assert "@media (max-width" not in css
    assert css.count("@container (max-width: 720px)") == 2


def test_the_readme_of_an_exercise_stands_beside_it(integrators, everything):
    one = made(everything, "exercise", "integrators")
    whole = "\n".join(text(cell) for cell in cells(one.data, "markdown"))
    for line in integrators.readme_path.read_text(encoding="utf-8").split("\n"):
        here = line.replace("`integrators.py`", "this notebook").replace("`course check", "`%course_check")
        assert here in whole or "import" in line
    assert "README" not in whole
