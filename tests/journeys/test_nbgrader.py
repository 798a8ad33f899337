"""What nbgrader makes of the notebooks written for it.

Needs an environment with nbgrader beside the course's own dependencies; it is no extra of the course.
"""

import json
import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest

from course.catalog.load import Catalog
from course.handed_in.notebook import notebook_source
from course.notebooks.build import pieces
from course.scoring.judging.session import GradingSession
from course.scoring.judging.submission import Submission

ROOT = Path(__file__).resolve().parents[2]

pytestmark = [
    pytest.mark.soak,
    pytest.mark.skipif(find_spec("nbgrader") is None, reason="nbgrader is not installed"),
]


def nbgrader(site, *words):
    # It calls the programs that came with it by name.
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    environment = os.environ | {"PYTHONPATH": str(ROOT), "HOME": str(site), "PATH": path}
    command = [sys.executable, "-m", "nbgrader", *words, f"--CourseDirectory.root={site}"]
    return subprocess.run(command, cwd=site, env=environment, text=True, capture_output=True, check=False)


def filled(release, texts):
    """A student's notebook: the release with functions written into its cells."""
    notebook = json.loads(release.read_text("utf-8"))
    for cell in notebook["cells"]:
        tags = cell["metadata"].get("course", {})
        if tags.get("role") == "solution":
            cell["source"] = texts.get(tags["task"], cell["source"])
    return json.dumps(notebook).encode()


def test_nbgrader_makes_validates_and_grades_the_assignment(tmp_path):
    catalog = Catalog()
    exercise = catalog.exercise("integrators")
    solution = (catalog.content.solutions / "integrators" / "integrators.py").read_text("utf-8")
    tasks = {task.id for task in exercise.task}
    texts = {piece.task: piece.text for piece in pieces(solution, tasks)[1] if piece.task}
    build = [sys.executable, "-m", "course", "notebook", "build", "integrators", "--format", "nbgrader"]
    subprocess.run(
        [*build, "--out", str(tmp_path)], check=True, cwd=tmp_path, env=os.environ | {"PYTHONPATH": str(ROOT)}
    )
    made = nbgrader(tmp_path, "generate_assignment", "integrators", "--create")
    assert made.returncode == 0, made.stderr
    release = tmp_path / "release" / "integrators" / "integrators.ipynb"
    text = release.read_text("utf-8")
    assert "YOUR CODE HERE" in text
    assert "SOLUTION" not in text

    wrong = texts | {"rk4_step": texts["rk4_step"].replace("h / 6", "h / 5")}
    del wrong["integrate"]
    odd = {
        "syntax": texts | {"rk4_step": "def rk4_step(:\n"},
        "asks": texts | {"rk4_step": texts["rk4_step"] + "\nname = input('Who? ')"},
        "copy": texts
        | {"max_stable_step": texts["max_stable_step"] + "\n\n\ndef rk4_step(*_):\n    return 0"},
    }
    for student, functions in (("ada", texts), ("bob", wrong), *odd.items()):
        folder = tmp_path / "submitted" / student / "integrators"
        folder.mkdir(parents=True)
        (folder / "integrators.ipynb").write_bytes(filled(release, functions))

    good = nbgrader(tmp_path, "validate", "submitted/ada/integrators/integrators.ipynb")
    assert "Success! Your notebook passes all the tests." in good.stdout, good.stdout + good.stderr
    bad = nbgrader(tmp_path, "validate", "submitted/bob/integrators/integrators.ipynb")
    assert "VALIDATION FAILED" in bad.stdout.upper(), bad.stdout + bad.stderr

    graded = nbgrader(tmp_path, "autograde", "integrators", "--create")
    assert graded.returncode == 0, graded.stderr
    scores = recorded(tmp_path)
    with GradingSession(exercise, catalog) as session:
        full = session.grade(Submission({"integrators.py": solution.encode()}))
        assert full.all_pass
        assert scores["ada"] == pytest.approx(full.max_score) == scores["asks"]
        assert 0 < scores["bob"] < scores["ada"]
        assert scores["syntax"] == pytest.approx(scores["copy"])
        for student in odd:
            handed_in = (tmp_path / "submitted" / student / "integrators" / "integrators.ipynb").read_bytes()
            ours = session.grade(notebook_source(handed_in, exercise).submission(exercise))
            assert scores[student] == pytest.approx(ours.score), student


def recorded(site):
    """Scores by student, as nbgrader keeps them."""
    from nbgrader.api import Gradebook

    gradebook: Any
    with Gradebook(f"sqlite:///{site / 'gradebook.db'}") as gradebook:
        return {one.student.id: one.score for one in gradebook.assignment_submissions("integrators")}
