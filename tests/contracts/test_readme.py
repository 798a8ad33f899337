"""What the README shows and counts at first sight, and where its links lead."""

import re
import tomllib
from pathlib import Path

from course.catalog.load import Catalog
from course.cli.author.pictures import PICTURES
from course.cli.frame.app import run
from course.engines.registry import ENGINES
from course.engines.scenarios import SCENARIOS

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")


def test_no_picture_is_stale(capsys):
    """`course author pictures` makes them anew."""
    assert run(["author", "pictures", "--check"]) == 0, capsys.readouterr().out


def test_the_pictures_of_the_readme_are_those_that_are_made():
    shown = re.findall(r"(?:src=\"|\]\()(docs/pictures/[^\")]+)", README)
    assert sorted(shown) == sorted(f"docs/pictures/{name}" for name in PICTURES)
    assert all((ROOT / path).is_file() for path in shown)


def test_the_picture_of_a_diagnosis_shows_the_finding_and_the_line():
    words = re.sub(r"<[^>]+>", " ", (ROOT / "docs/pictures/diagnosis.svg").read_text(encoding="utf-8"))
    words = " ".join(words.replace("&#160;", " ").split())
    for said in ("steps of semi-implicit Euler", "x = x + h * v_next"):
        assert said in words


def test_what_the_readme_counts_is_so():
    """Its numbers, in its order, and what each of them counts."""
    catalog = Catalog()
    minutes = [catalog.exercise(name).minutes for name in catalog.warm_up_ids()]
    words = {7: "seven", 14: "fourteen"}
    for said in (
        f"puts {words[len(SCENARIOS)]} tests with known answers to",
        f"to pymunk and up to {words[len(ENGINES) - 1]} more",
    ):
        assert said in README
    assert minutes.count(5) > len(minutes) / 2
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    assert "Python 3.11 or newer" in README
    assert project["requires-python"] == ">=3.11"


def test_the_links_of_the_readme_lead_somewhere():
    for target in re.findall(r"\]\(([^)#:]+)\)", README):
        assert (ROOT / target).exists(), target
