"""A lesson by typed lines, and what else is met with ``--plain``: all of it, and each fact once."""

import io
import re
from collections import Counter

import pytest

from course.authoring.exercises.grading import solution_path
from course.catalog.blocks import Prediction
from course.cli.frame import app
from course.cli.frame.console import Console, Settings, install
from course.cli.frame.here import Here
from course.cli.reading.by_line import LineReader
from course.cli.reading.lesson import paginate, printer, sentences
from course.reading.parts import read_script
from course.reading.record import predictions_of
from tests.unit.cli.conftest import Said
from tests.unit.cli.reading.conftest import CATALOG

pytestmark = pytest.mark.usefixtures("sandboxes")
LESSON = "numerical-integration"
OFFERS = re.compile(r"Here (1 2 3 say|r runs|start puts|check runs)")
_PAGES = paginate(read_script(CATALOG.lesson(LESSON), CATALOG.tasks(LESSON)).blocks)
#: The page that ends with the first prediction, 1 for the first page.
ASKED = 1 + next(at for at, page in enumerate(_PAGES) if isinstance(page[-1], Prediction))


@pytest.fixture
def workspace(mine, monkeypatch):
    monkeypatch.chdir(mine.root)
    return mine


class Typed:
    """A console on which somebody types; what was said and what was asked are kept apart."""

    def __init__(self, answer):
        self.out, self.asked = io.StringIO(), list[str]()
        self._answer = answer
        self.console = install(Console(Settings(plain=True), stdout=self.out, stderr=self.out))
        self.console.ask = self._ask

    def _ask(self, question):
        self.asked.append(question)
        return self._answer(question)

    def read(self, lesson, here):
        chosen = CATALOG.lesson(lesson)
        return LineReader(self.console, here, CATALOG, chosen, self.prints(lesson)).read()

    def prints(self, lesson):
        script = read_script(CATALOG.lesson(lesson), CATALOG.warm_ups(lesson))
        return printer(CATALOG, script, self.console.rich(), plain=True)

    @property
    def said(self):
        return self.out.getvalue()

    def says(self, *words):
        """In this order."""
        return Said(self.said).says_in_order(*words)


def lines(*typed):
    """These lines, one after the other; at their end the input ends."""
    left = iter(typed)
    return lambda _: next(left, None)


@pytest.mark.parametrize("lesson", CATALOG.lesson_ids())
def test_every_lesson_is_there_whole_and_says_each_fact_once(lesson, workspace):
    someone = Typed(lambda question: "it grows" if question.startswith("Your prediction") else "")
    assert someone.read(lesson, Here.load())
    printed = Typed(lambda _: None)
    chosen = CATALOG.lesson(lesson)
    prints = printed.prints(lesson)
    prints.head()
    prints.blocks(read_script(chosen, CATALOG.warm_ups(lesson)).blocks)
    ours = {"", "Kept.", "You said: it grows", "What you type below a page does something; ? lists what."}
    said = [line for line in someone.said.splitlines() if line not in ours and not OFFERS.match(line)]
    tasks = CATALOG.tasks(lesson)
    warm_ups = [line for line in printed.said.splitlines() if line.startswith("Try: course warmup ")]
    assert sorted(warm_ups) == sorted(f"Try: course warmup {one.id}" for one in CATALOG.warm_ups(lesson))
    named = {*warm_ups, *(f"Warm-up, {one.minutes} minutes: {one.title}" for one in tasks)}
    assert [line for line in printed.said.splitlines() if line and line not in named] == [
        line for line in said if not any(f"({one.id})" in line or line == one.summary for one in tasks)
    ]
    assert all(someone.said.count(f"{one.title} ({one.id})") == 1 for one in tasks)
    assert someone.said.count("Here start puts its file into your workspace.") == len(tasks)
    asked = len(read_script(chosen).questions)
    assert sum(question.startswith("Your prediction") for question in someone.asked) == asked
    assert repeated("\n".join(said)) == []
    assert "\x1b" not in someone.said


def test_a_prediction_comes_before_its_answer_and_is_judged_below_it(workspace):
    typed = Typed(lines(f"g {ASKED}", "b", "", "it grows", "2", "1", "q"))
    assert not typed.read(LESSON, Here.load())
    typed.says("Predict first: ", "Kept.", "Answer: ", "You said: it grows", "Kept: nearly right.")
    typed.says("No prediction is answered on this page.")  # it was judged
    (one,) = predictions_of(workspace.store.events())
    assert (one.text, one.judged) == ("it grows", "nearly")


def test_no_way_leads_past_an_open_prediction(workspace):
    typed = Typed(lines("g 999", "g x", f"g {ASKED + 1}", "q"))
    typed.read(LESSON, Here.load())
    assert typed.said.count("g takes the number of a page, 1 to ") == 2
    typed.says("Predict first.\n").lacks("Answer: ")
    assert typed.asked[-1].startswith("Your prediction")
    after = Typed(lines("course check integrators", "r 1", "q"))
    after.read(LESSON, Here.load())
    does_nothing = "'course check integra' does nothing here, and this is not the shell"
    after.says(f"Going on with page {ASKED} of ", does_nothing)
    assert predictions_of(workspace.store.events())[0].text == "r 1", "at a prediction it is one"


def test_contents_search_and_an_unknown_word(workspace):
    typed = Typed(lines("t", "/ shadow hamiltonian", "/ compass", "dance", "?", "n", "q"))
    typed.read(LESSON, Here.load())
    assert re.search(r"^Not in this lesson, unless behind one of \d+ open predictions\.$", typed.said, re.M)
    does_nothing = "'dance' does nothing here, and this is not the shell; ? lists what does."
    typed.says(": Fingerprints\n", "compass", does_nothing, "q or Ctrl-C: stop")
    assert any(question.startswith("Page 2 ") for question in typed.asked), "n goes on"


def test_a_cell_runs_is_changed_in_a_file_and_put_back(workspace):
    """Beyond its prediction, which is skipped; what a cell prints as recorded is not said again."""
    cell = read_script(CATALOG.lesson(LESSON)).shown_cells[0]
    name = f"{LESSON}-1.py"

    def answer(question):
        if question.startswith("Your prediction"):
            return ""
        if "r runs cell 1," not in typed.said:
            return ""
        step = next(steps, None)
        if step == "changed":
            (workspace.root / name).write_text("print('mine')\n", "utf-8")
            return "r"
        return step

    steps = iter(["r", "r 999", "e", "changed", "u", "r", "q"])
    typed = Typed(answer)
    assert not typed.read(LESSON, Here.load())
    assert typed.said.count("and printed the same.") == 2
    typed.says("No cell 999 in this lesson.", "and printed, 1 line:\nmine\nEnd of output\n")
    assert typed.said.count(cell.output.splitlines()[0]) == 1
    kinds = [event.data for event in workspace.store.events("cell")]
    assert [data.get("printed") for data in kinds if "ran" in data][1] == "mine"


def test_outside_of_a_workspace_it_reads_and_says_what_a_task_needs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    typed = Typed(lambda question: "start" if "Make a workspace" not in typed.said and at_a_task() else "")

    def at_a_task():
        return typed.said.rstrip().endswith(CATALOG.tasks(LESSON)[0].summary)

    assert typed.read(LESSON, None)
    assert typed.said.count("Make a workspace first: course init my-course") == 1


def test_a_prediction_that_cannot_be_recorded_is_not_called_kept_and_the_reason_comes_at_once(workspace):
    here = Here.load()
    workspace.root.rename(workspace.root.with_name("moved"))
    typed = Typed(
        lambda question: "q" if "Not kept." in typed.said else "it grows" if "pred" in question else ""
    )
    assert not typed.read(LESSON, here)
    assert "Kept." not in typed.said
    assert typed.said.count("it was moved or removed") == 1
    assert not workspace.root.exists()


EXERCISE = "integrators"
#: Code, output and tables are as they are: a cell of a table may say what another says.
_VERBATIM = re.compile(r"^(Python code|It prints|Text|Table), \d+ ")
#: A formula may come back; and four functions may each pass a check of the same name.
_MAY_COME_BACK = ("Formula: ", "pass: ")
#: Fewer words are a label, such as "diagnosis: TIMEOUT".
_WORDS = 5
WRONG = """

def explicit_euler_step(accel, t, q, v, h):
    v = v + h * accel(t, q, v)
    return q + h * v, v


def integrate(*_):
    return 1
"""


def repeated(text):
    """Sentences that are there more than once."""
    said = Counter()
    verbatim = False
    for line in text.splitlines():
        verbatim = verbatim or bool(_VERBATIM.match(line))
        if not verbatim and not line.strip().startswith(_MAY_COME_BACK):
            said.update(one for one in sentences(line.strip()) if len(one.split()) >= _WORDS)
        verbatim = verbatim and not line.startswith("End of ")
    return [one for one, count in said.items() if count > 1]


def test_a_sentence_that_is_said_twice_is_found():
    once = "The energy grows by four per cent."
    code = "Python code, 1 lines:\nx = 1  # the energy grows by itself\nEnd of python code\n"
    assert repeated(f"{once}\n{code}{code}") == []
    assert repeated(f"{once}\nMore of it here. {once}\n") == [once]


def heard(capsys, *words):
    capsys.readouterr()
    app.run((*words, "--plain"))
    said = capsys.readouterr()
    assert "\x1b" not in said.out
    return said.out + said.err


def test_the_way_through_an_exercise(tmp_path, monkeypatch, capsys):
    """Started, failed, hinted at, mended, looked back at."""
    assert app.run(("init", str(tmp_path / "mine"))) == 0
    monkeypatch.chdir(tmp_path / "mine")
    path = tmp_path / "mine" / EXERCISE / f"{EXERCISE}.py"
    right = solution_path(CATALOG, CATALOG.exercise(EXERCISE)).read_text("utf-8")
    steps = [("start", EXERCISE), ("check", EXERCISE), ("hint", EXERCISE)]
    steps += [("exercises",), ("lessons",), ("warmup",), ("next",), (), ("progress",)]
    found = {words: repeated(heard(capsys, *words)) for words in steps}
    for wrong in (WRONG, ""):
        path.write_text(right + wrong, "utf-8")
        for words in (*steps[1:3], ("check", EXERCISE, "--verbose"), ("progress",)):
            found[(*words, f"wrong: {bool(wrong)}")] = repeated(heard(capsys, *words))
    # Two objectives may have the same evidence.
    found[()] = [one for one in found[()] if not one.startswith("lessons read: ")]
    assert {words: twice for words, twice in found.items() if twice} == {}
