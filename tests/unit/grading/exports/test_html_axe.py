"""The pages in a real browser: axe-core's rules, in light and dark, on a desk and on a phone."""

import contextlib
import shutil
import subprocess

import pytest

from course.grading.exports.formats import export
from course.grading.exports.selection import ExportOptions
from course.grading.gradebook.records import GradedExercise, Override, Result, SubmittedAt
from course.grading.results.effective import Results
from course.grading.similar import Document, Group, Pair, Parser, Similar
from course.grading.similar import page as similar_page
from tests.browsers import CHROMIUM, FLAGS, axe_core
from tests.unit.grading.exports.test_html import quiz_verdict
from tests.unit.grading.made import BROKEN, HALF, HOSTILE, REFUSED, RIGHT, WRONG, digest, key, make_book
from tests.unit.grading.test_results import DUE, POLICY

pytestmark = pytest.mark.soak

_RULES = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"]
_SCREENS = [(1280, "light"), (1280, "dark"), (390, "light")]
_STUDENTS = ["students/1.html", "students/2.html", "students/3.html"]
_PAGES = ["report.html", "students.html", "similar.html", *_STUDENTS]
_ORIGINAL = (
    "def double(x):\n" + "".join(f"    y{n} = x * {n} + {n % 7}\n" for n in range(60)) + "    return 2 * x\n"
)
_COPY = _ORIGINAL.replace("x", "number").replace("y", "value")


@pytest.fixture(scope="module")
def axe(tmp_path_factory):
    return axe_core(tmp_path_factory.mktemp("axe"))


@pytest.fixture(scope="module")
def browser():
    if CHROMIUM is None:
        pytest.skip("Chromium is missing")
    reason = "playwright is missing: pip install 'physics-sim-course[dev]'"
    playwright = pytest.importorskip("playwright.sync_api", reason=reason)
    with playwright.sync_playwright() as started:
        opened = started.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield opened
        opened.close()


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    out = tmp_path_factory.mktemp("pages")
    verdicts = {"0 wrong": WRONG, "1 late": RIGHT, "2 broken": BROKEN, "3 set": HALF}
    verdicts |= {name: (RIGHT, HALF, REFUSED)[at % 3] for at, name in enumerate(HOSTILE)}
    # Sorted before everything else, so that the pages tried are these.
    with make_book(out, {name: verdict for name, verdict in verdicts.items() if name[0].isdigit()}) as book:
        for name in HOSTILE:
            book.add(Result(key("x" + name), verdicts[name]))
        book.set_exercises([GradedExercise("quiz", "Quiz", 5.0, 0.8, 1_000_000)])
        book.add(Result(key("0 wrong", "quiz"), quiz_verdict(3)))
        book.add_override(Override("3 set", "doubling", 8.25, "said <b>so</b>"))
        at = DUE.timestamp() + 2 * 86_400
        book.add_times([SubmittedAt("1 late", "doubling", digest("1 late"), "gradescope", at)])
        book.set_meta(late_policy=POLICY)
        export(Results(book), "html", out, None, ExportOptions())
    (out / "similar.html").write_text(similar_page(likeness()), "utf-8")
    return out


def likeness():
    """Two copies under hostile names, and what could not be read."""
    with contextlib.closing(Parser()) as parse:
        one, two = (
            Document(name, source, parse(source.encode()))
            for name, source in ((HOSTILE[0], _ORIGINAL), ("Ada\u202eevoL", _COPY))
        )
    passages = (((1, 20), (1, 20)), ((20, 62), (20, 62)), ((1, 5), (40, 44)))
    pair = Pair("doubling", one, two, 0.973, passages, 62)
    group = Group("doubling", (HOSTILE[0], "Ada\u202eevoL", "x" * 300), 0.7)
    return Similar([pair, pair], [group], 300, ["<b>bob</b> doubling"], 7)


@pytest.mark.parametrize("name", _PAGES)
@pytest.mark.parametrize(("width", "scheme"), _SCREENS)
def test_axe_finds_nothing(browser, axe, folder, name, width, scheme):
    context = browser.new_context(
        viewport={"width": width, "height": 900}, color_scheme=scheme, bypass_csp=True
    )
    page = context.new_page()
    page.goto((folder / name).as_uri())
    page.evaluate("document.querySelectorAll('details').forEach(item => { item.open = true; })")
    page.evaluate(axe)
    run = "tags => axe.run(document, {runOnly: tags}).then(found => found)"
    found = page.evaluate(run, _RULES)
    context.close()
    assert [
        (item["id"], [node["html"][:120] for node in item["nodes"][:3]]) for item in found["violations"]
    ] == []
    assert len(found["passes"]) > 10, "axe looked at something"


@pytest.mark.parametrize("name", _PAGES)
def test_a_page_asks_for_nothing_and_fits_a_phone(browser, folder, name):
    """As it is, its policy in force: no message, no request beside the file, no sideways scrolling."""
    context = browser.new_context(viewport={"width": 390, "height": 844})
    page = context.new_page()
    said = []
    asked = []
    page.on("console", lambda message: said.append(message.text))
    page.on("pageerror", lambda error: said.append(str(error)))
    page.on("request", lambda request: asked.append(request.url))
    page.goto((folder / name).as_uri())
    width = page.evaluate("document.documentElement.scrollWidth")
    cut = page.evaluate(
        "[...document.querySelectorAll('.scroll')].filter(one => one.scrollWidth > one.clientWidth + 1)"
        ".map(one => one.ariaLabel)"
    )
    context.close()
    assert said == []
    assert asked == [(folder / name).as_uri()]
    assert width == 390
    assert cut == [], "no column of a table lies beside the screen"


def test_tables_sort_and_filter_by_keyboard(browser, folder):
    page = browser.new_page()
    page.goto((folder / "students.html").as_uri())
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.textContent") == "Skip to the content"
    page.get_by_role("button", name="Doubling").focus()
    page.keyboard.press("Enter")
    column = "rows => rows.map(row => row.cells[2].dataset.value).filter(Boolean).map(Number)"
    scores = page.eval_on_selector_all("tbody tr", column)
    assert scores == sorted(scores)
    assert page.locator("th[aria-sort=ascending]").inner_text().startswith("Doubling")
    page.keyboard.press("Space")
    assert page.eval_on_selector_all("tbody tr", column) == sorted(scores, reverse=True)
    page.get_by_label("Show rows with").fill("LATE")
    assert page.get_by_role("status").inner_text() == f"1 of {len(HOSTILE) + 4} shown"
    assert page.locator("tbody tr:visible").count() == 1
    page.close()


def printed(browser, path, tmp_path, prepare=""):
    """The text of each sheet of A4."""
    pdftotext = shutil.which("pdftotext")
    if pdftotext is None:
        pytest.skip("pdftotext (poppler-utils) is missing: what is printed cannot be read back")
    page = browser.new_page()
    page.goto(path.as_uri())
    if prepare:
        page.evaluate(prepare)
    page.pdf(path=str(tmp_path / "printed.pdf"), format="A4", prefer_css_page_size=True)
    page.close()
    command = [pdftotext, "-layout", str(tmp_path / "printed.pdf"), "-"]
    done = subprocess.run(command, capture_output=True, check=True)
    return done.stdout.decode("utf-8").split("\f")[:-1]


def test_a_long_table_has_its_headings_on_every_sheet(browser, folder, tmp_path):
    many = (
        "for (const row of [...document.querySelectorAll('tbody tr')])"
        " for (let n = 0; n < 4; n++) row.after(row.cloneNode(true))"
    )
    sheets = printed(browser, folder / "students.html", tmp_path, many)
    assert len(sheets) > 2
    assert all("Doubling, of 10" in sheet for sheet in sheets[:-1])
    assert not [sheet for sheet in sheets if "Show rows with" in sheet]
    # A heading is never the last thing on a sheet, wherever the sheet happens to end.
    for lines in range(0, 40, 8):
        push = f"document.querySelector('header').style.paddingBottom = '{lines}rem'"
        for sheet in printed(browser, folder / "report.html", tmp_path, push)[:-1]:
            assert not sheet.strip().endswith(("Points earned", "Students", "Passed")), sheet


def test_of_similar_submissions_what_is_open_is_printed(browser, folder, tmp_path):
    """Following the link of a pair opens it."""
    text = "\n".join(printed(browser, folder / "similar.html", tmp_path))
    assert "97" in text
    assert "def double(x)" not in text
    page = browser.new_page()
    page.goto((folder / "similar.html").as_uri())
    page.locator("tbody a").first.click()
    assert page.locator("details[open]").count() == 1
    page.get_by_label("passage 2, opposite").first.click()
    assert page.evaluate("location.hash") == "#p1-b-2"
    page.close()
    open_first = "document.querySelector('details').open = true"
    sheets = printed(browser, folder / "similar.html", tmp_path, open_first)
    (sheet,) = (sheet for sheet in sheets if "and Ada\\u202eevoL: 97" in sheet)
    assert "def double(x)" in sheet
    assert "def double(number)" in sheet
    assert "\n".join(sheets).count("def double(x)") == 1


def test_a_students_sheet_is_not_left_empty(browser, folder, tmp_path):
    """What does not fit on the first sheet is begun there."""
    sheets = printed(browser, folder / "students" / "1.html", tmp_path)
    assert len(sheets) > 1
    assert "3 of 5 points" in sheets[0], "the quiz, which ends on the second"
