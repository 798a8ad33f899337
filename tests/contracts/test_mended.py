"""The unseen mistakes of ``tests/benchmarks/mended``: what is asked must not say what is wrong."""

import ast
import importlib.util
from pathlib import Path

import pytest

from course.authoring.exercises.variants import solution_path
from course.catalog.load import Catalog

FOLDER = Path(__file__).resolve().parents[1] / "benchmarks" / "mended"
MISTAKES = sorted(FOLDER.glob("mistakes/*/*.py"))


@pytest.fixture(scope="module")
def mended():
    spec = importlib.util.spec_from_file_location("mended", FOLDER / "mended.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_a_wrong_module_holds_neither_the_right_definition_nor_the_comment(mended):
    catalog = Catalog()
    for path in MISTAKES:
        solution = solution_path(catalog, catalog.exercise(path.parent.name))
        text = mended.joined(solution, path)
        names = [node.name for node in ast.parse(text).body if isinstance(node, ast.FunctionDef)]
        assert len(names) == len(set(names)), path
        assert ast.dump(ast.parse(text)) != ast.dump(ast.parse(solution.read_text())), path
        assert path.read_text().splitlines()[0] not in text, path


def test_there_are_at_least_eleven_mistakes_for_each_exercise():
    counts = [len(list(folder.glob("*.py"))) for folder in (FOLDER / "mistakes").iterdir() if folder.is_dir()]
    assert len(counts) == 6
    assert min(counts) >= 11
