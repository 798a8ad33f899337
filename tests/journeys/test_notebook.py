"""A notebook's way: built, filled in, checked in its kernel, handed in, and graded as the file is.

What the check in the notebook says, what `submit` says and what a grading run finds are one thing, whatever
the kernel has run besides.
"""

import contextlib
import json
import os
import time
from importlib.util import find_spec

import pytest
from nbformat.v4 import new_code_cell

from course.catalog.load import Catalog
from course.notebooks.build import pieces
from tests.journeys.conftest import in_turn, model, results

CATALOG = Catalog()
EXERCISES = CATALOG.exercises()
INTEGRATORS = CATALOG.exercise("integrators")
NO_KERNEL = [name for name in ("jupyter_client", "ipykernel") if find_spec(name) is None]
with_kernel = pytest.mark.skipif(bool(NO_KERNEL), reason=f"the extra notebook is not installed: {NO_KERNEL}")


def fill(path, exercise):
    """Write the solution into the notebook as a student does: each function into its cell, the rest above."""
    notebook = json.loads(path.read_text("utf-8"))
    parts = pieces(model(exercise), {task.id for task in exercise.task})[1]
    texts = {part.task: part.text for part in parts if part.task}
    others = "\n\n".join(part.text for part in parts if not part.task)
    roles = [cell["metadata"].get("course", {}) for cell in notebook["cells"]]
    for cell, tags in zip(notebook["cells"], roles, strict=True):
        if tags.get("role") == "solution":
            cell["source"] = texts[tags["task"]]
        elif tags.get("role") == "setup":
            cell["source"], others = others, ""
    path.write_text(json.dumps(notebook), "utf-8")


def submitted(student, workspace):
    """What `submit` says of each file that goes in."""
    reply = json.loads(student("submit", "--json", cwd=workspace).stdout)
    return {
        file["path"].partition("/")[0]: (file["last_score"], file["max_score"]) for file in reply["files"]
    }


def graded(instructor, workspace):
    """The results of a grading run over what `submit` wrote."""
    place = workspace.parent / "class" / "kim"
    place.mkdir(parents=True, exist_ok=True)
    (place / "mine.zip").write_bytes((workspace / "physics-sim-submission.zip").read_bytes())
    out = workspace.parent / f"out-{time.monotonic_ns()}"
    instructor("grade", "run", place.parent, "--out", out, "-j", "2")
    return {exercise: line for (_, exercise), line in results(out).items()}


def public(line):
    """Points and maximum of the public part of a grading."""
    checks = [check for check in line["checks"] if check["visibility"] == "public"]
    return sum(check["points"] for check in checks), sum(check["max_points"] for check in checks)


def test_every_exercise_in_its_notebook_is_graded_as_the_file_is(student, instructor, workspace):
    tried = in_turn(EXERCISES, 2)
    student("notebook", "build", *(exercise.id for exercise in tried), cwd=workspace)
    for exercise in tried:
        path = workspace / exercise.id / exercise.module.replace(".py", ".ipynb")
        fill(path, exercise)
        if exercise in in_turn(tried):
            assert student("notebook", "check", path, cwd=workspace).stdout
    said = submitted(student, workspace)
    assert said.keys() == {exercise.id for exercise in tried}
    assert all(score == most > 0 for score, most in said.values())
    results = graded(instructor, workspace)
    for exercise in tried:
        line = results[exercise.id]
        assert (line["state"], line["score"]) == ("graded", exercise.max_points), (exercise.id, line["error"])
        assert public(line) == said[exercise.id]


# -- in a kernel ------------------------------------------------------------------------------------------


class Kernel:
    """A kernel of a notebook, spoken to as JupyterLab does: each cell comes with its id."""

    def __init__(self, path, environment):
        from jupyter_client.manager import KernelManager

        self.path = path
        self._manager = KernelManager(kernel_name="python3")
        # JupyterLab tells a kernel in this way whose it is.
        env = {**os.environ, **environment, "JPY_SESSION_NAME": str(path)}
        self._manager.start_kernel(cwd=str(path.parent), env=env)
        self._client = self._manager.blocking_client()
        self._client.start_channels()
        self._client.wait_for_ready(timeout=120)

    def run(self, text, cell=""):
        """Run a cell; what it printed and showed."""
        client = self._client
        content = {
            "code": text, "silent": False, "store_history": True, "user_expressions": {},
            "allow_stdin": False, "stop_on_error": True,
        }  # fmt: skip
        message = client.session.msg("execute_request", content, metadata={"cellId": cell} if cell else {})
        client.shell_channel.send(message)
        said = []
        while True:
            answer = client.get_iopub_msg(timeout=120)
            if answer["parent_header"].get("msg_id") != message["header"]["msg_id"]:
                continue
            told = answer["content"]
            if answer["msg_type"] == "stream":
                said.append(told["text"])
            elif answer["msg_type"] in {"execute_result", "display_data"}:
                said.append(told["data"]["text/plain"])
            elif answer["msg_type"] == "error":
                said.append("\n".join(told["traceback"]))
            elif answer["msg_type"] == "status" and told["execution_state"] == "idle":
                return "\n".join(said)

    def cells(self):
        return json.loads(self.path.read_text("utf-8"))["cells"]

    def run_all(self):
        """Run every code cell of the file; what the last one showed."""
        said = ""
        for cell in self.cells():
            if cell["cell_type"] == "code":
                said = self.run("".join(cell["source"]), cell["id"])
        return said

    def close(self):
        self._client.stop_channels()
        self._manager.shutdown_kernel(now=True)


@pytest.fixture
def kernel(student, workspace):
    """The kernel of the solved notebook of ``integrators``."""
    student("notebook", "build", "integrators", cwd=workspace)
    path = workspace / "integrators" / "integrators.ipynb"
    fill(path, INTEGRATORS)
    with contextlib.closing(Kernel(path, {"PYTHONPATH": student.environment.get("PYTHONPATH", "")})) as made:
        made.run("%load_ext course.notebooks")
        yield made


def edit(path, change):
    """Change the file's cells and save it."""
    notebook = json.loads(path.read_text("utf-8"))
    change(notebook["cells"])
    path.write_text(json.dumps(notebook), "utf-8")
    later = time.time() + 0.05  # than whatever was run till now
    os.utime(path, (later, later))
    time.sleep(0.1)


def of_task(cells, task):
    return next(
        cell
        for cell in cells
        if cell["metadata"].get("course", {}).get("role") == "solution"
        and cell["metadata"]["course"]["task"] == task
    )


OLD = "def rk4_step(accel, t, q, v, h):\n    return q + h * v, v"
HALF = "def half(h):\n    return h / 2"
CHECK = "%course_check integrators"


@with_kernel
def test_what_the_kernel_has_run_besides_changes_nothing(kernel, student, instructor, workspace):
    """A call under a function, a helper that was deleted, an old copy: each is judged as it is graded."""
    kernel.run_all()
    assert "40 of 40 points" in kernel.run(CHECK)

    def below_integrate(cells):
        of_task(cells, "integrate")["source"] += "\nprint(max_stable_step(explicit_euler_step, 1.0))\n"

    edit(kernel.path, below_integrate)
    assert "40 of 40 points" in kernel.run(CHECK)

    # Run, used, and deleted from the notebook.
    kernel.run(HALF, "helper")
    cell = of_task(kernel.cells(), "rk4_step")
    source = "".join(cell["source"]).replace("h / 2", "half(h)")
    edit(kernel.path, lambda cells: of_task(cells, "rk4_step").update(source=source))
    kernel.run(source, cell["id"])
    said = kernel.run(CHECK)
    assert "name 'half' is not defined" in said
    assert "40 of 40 points" not in said

    # And an old wrong copy, below, that was run long ago.
    edit(kernel.path, lambda cells: cells.insert(5, new_code_cell(HALF, id="helper")))
    assert "40 of 40 points" in kernel.run(CHECK)
    edit(kernel.path, lambda cells: cells.append(new_code_cell(OLD, id="old")))
    said = kernel.run(CHECK)
    assert "`rk4_step` is defined more than once" in said
    assert "40 of 40 points" not in said
    handed, found = submitted(student, workspace), graded(instructor, workspace)["integrators"]
    assert handed["integrators"] == public(found)
    assert f"{handed['integrators'][0]:g} of 40 points" in said


@with_kernel
def test_what_is_not_saved_or_not_run_is_said(kernel):
    kernel.run_all()
    cell = of_task(kernel.cells(), "rk4_step")
    time.sleep(0.05)
    said = kernel.run(OLD, cell["id"]) + kernel.run(CHECK)
    assert "40 of 40 points" not in said
    assert "integrators.ipynb is not saved as you ran it: In [" in said
    said = kernel.run("%course_submit integrators", "hand-in")
    assert "40/40 points" in said  # of the file
    assert "is not saved as you ran it" in said
    edit(kernel.path, lambda cells: of_task(cells, "rk4_step").update(source=OLD + "  # saved, not run"))
    said = kernel.run(CHECK)
    assert "Changed since you ran it: In [" in said
    assert "40 of 40 points" not in said


@with_kernel
def test_hints_and_other_cells_without_code_are_nothing_to_save(kernel):
    kernel.run_all()
    time.sleep(0.05)
    said = kernel.run("%course_hint integrators rk4_step", "hint") + kernel.run("1 + 1", "sum")
    assert "Next: %course_check integrators" in said
    said = kernel.run(CHECK)
    assert "40 of 40 points" in said
    assert "not saved" not in said
    assert "left out" not in said


@with_kernel
def test_a_check_in_a_notebook_that_is_not_handed_in_says_so(kernel):
    kernel.run_all()
    module = kernel.path.with_suffix(".py")
    module.write_text("x = 1\n")
    assert "integrators.py was worked in too: that is what is handed in" in kernel.run(CHECK)
    module.unlink()
    copy = kernel.path.with_name("integrators-Copy1.ipynb")
    copy.write_bytes(kernel.path.read_bytes())
    with contextlib.closing(Kernel(copy, {})) as other:
        other.run("%load_ext course.notebooks")
        said = other.run(CHECK)
    assert "integrators-Copy1.ipynb is not what is handed in: that is integrators/integrators.ipynb" in said


@with_kernel
def test_after_a_restart_the_check_judges_the_file(kernel):
    assert "40 of 40 points" in kernel.run(CHECK)
