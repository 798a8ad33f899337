"""The unseen mistakes of ``tests/benchmarks/mended``: what is asked must not say what is wrong."""

import ast
import importlib.util
import itertools
import tomllib
from pathlib import Path

import pytest

from course.authoring.exercises.grading import mistakes_of, solution_path
from course.catalog.load import Catalog

FOLDER = Path(__file__).resolve().parents[2] / "benchmarks" / "mended"
MISTAKES = sorted([*FOLDER.glob("mistakes/*/*.py"), *FOLDER.glob("afresh/*/*.py")])


@pytest.fixture(scope="module")
def mended():
    spec = importlib.util.spec_from_file_location("mended", FOLDER / "mended.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_a_wrong_module_holds_neither_the_right_definition_nor_the_comment(mended):
    catalog = Catalog()
    for folder, paths in itertools.groupby(MISTAKES, lambda path: path.parent):
        solution = solution_path(catalog, catalog.exercise(folder.name))
        right = ast.dump(ast.parse(solution.read_text()))
        for path in paths:
            text = mended.joined(solution, path)
            tree = ast.parse(text)
            names = [node.name for node in tree.body if isinstance(node, ast.FunctionDef)]
            assert len(names) == len(set(names)), path
            assert ast.dump(tree) != right, path
            assert path.read_text().splitlines()[0] not in text, path


def test_what_misled_once_is_there_and_its_answer_is_kept(mended):
    rows = tomllib.loads(mended.ROWS.read_text(encoding="utf-8"))["row"]
    kept = mended.ROWS.with_name("told.md").read_text(encoding="utf-8")
    assert len(rows) >= 20
    catalog = Catalog()
    for row in rows:
        assert f"## {row['did']}" in kept
        for program in row["programs"]:
            exercise, _, name = program.partition(": ")
            if name.endswith(".py"):
                assert (mended.ROOT / name).is_file(), program
            else:
                assert name in {one.name for one in mistakes_of(catalog, catalog.exercise(exercise)).wrong}
            assert f"`{name.rpartition('/')[2].removesuffix('.py')}`" in kept


@pytest.mark.soak
def test_what_once_misled_is_told_what_the_page_says(mended, capsys):
    mended.rows()
    assert capsys.readouterr().out == (FOLDER / "misleading" / "told.md").read_text(encoding="utf-8")
