"""The figures: each can be drawn, looks as it did, says what it shows and can be told apart by anyone."""

import subprocess
import sys
from pathlib import Path

import pytest
from matplotlib.figure import Figure

from course.errors import NotFoundError, UsageError
from course.figures import registry
from course.figures.looks import faults, picture_and_words
from course.figures.style import METHODS, WIDTH_IN

GOLDEN = Path(__file__).parents[2] / "fixtures" / "golden"


@pytest.mark.parametrize("figure_id", ["integrators-energy", "integrators-order", "integrators-phase"])
def test_the_tolerance_sees_one_method_drawn_as_another(figure_id, monkeypatch):
    from course.figures import integrators

    swapped = {**integrators.STEPPERS, "explicit_euler": integrators.STEPPERS["semi_implicit_euler"]}
    monkeypatch.setattr(integrators, "STEPPERS", swapped)
    (fault,) = [fault for fault in faults(figure_id, GOLDEN) if "looks other" in fault.problem]
    assert fault.help.endswith(f"course author pictures {figure_id}")


def drawn(change):
    """A builder of a figure that is right but for one change."""

    def builder():
        figure = Figure(figsize=(WIDTH_IN, 3.0), layout="constrained")
        axes = figure.subplots()
        figure.suptitle("One straight line that goes up steadily")
        axes.plot([0.0, 1.0], [0.0, 1.0])
        axes.set(xlabel="time (s)", ylabel="height (m)")
        change(figure, axes)
        return figure

    return builder


@pytest.mark.parametrize(
    ("change", "problem"),
    [
        (lambda figure, axes: 1 / 0, "cannot be drawn: ZeroDivisionError"),
        (lambda figure, axes: figure.suptitle("A line"), "no title that says what it shows"),
        (lambda figure, axes: figure.set_figwidth(9.0), "is 9 inches wide"),
        (lambda figure, axes: axes.set_xlabel("time / s"), "the label 'time / s' without a unit"),
        (lambda figure, axes: axes.set_xlabel(""), "no label below its axes"),
        (
            lambda figure, axes: axes.text(5.0, 0.5, "far away").set_in_layout(False),
            "'far away' outside of the page",
        ),
        (
            lambda figure, axes: [axes.text(0.5, 0.5, text) for text in ("one", "two")],
            "'one' written over 'two'",
        ),
    ],
)
def test_a_figure_that_cannot_be_drawn_or_read_is_found(tmp_path, monkeypatch, change, problem):
    from course.figures import integrators

    kept = tmp_path / "kept"
    kept.mkdir()
    monkeypatch.setattr(integrators, "phase_portraits", drawn(lambda figure, axes: None))
    picture, words = picture_and_words("integrators-phase")
    (kept / "integrators-phase.png").write_bytes(picture)
    (kept / "integrators-phase.txt").write_bytes(words)
    assert list(faults("integrators-phase", kept)) == []
    monkeypatch.setattr(integrators, "phase_portraits", drawn(change))
    assert any(problem in fault.problem for fault in faults("integrators-phase", kept))


def test_a_figure_that_nobody_looked_at_is_told_its_cure(tmp_path):
    (fault,) = faults("integrators-stability", tmp_path)
    assert "no picture to be compared with" in fault.problem
    assert "course author pictures integrators-stability" in fault.help
    assert fault.file.name == "integrators.py"
    assert (fault.line or 0) > 1


def luminance(colour):
    parts = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def test_methods_differ_in_more_than_colour_and_their_names_are_legible_on_white():
    looks = METHODS.values()
    assert len({look.line for look in looks}) == len({look.marker for look in looks}) == len(METHODS)
    # WCAG 2.2, 1.4.3: letters need a contrast of 4.5 to 1.
    assert all(1.05 / (luminance(look.ink) + 0.05) >= 4.5 for look in looks)


def test_a_readers_own_settings_do_not_reach_a_figure():
    import matplotlib as mpl

    before = registry.png("integrators-stability")
    with mpl.rc_context({"font.size": 20.0, "axes.facecolor": "red"}):
        assert registry.png("integrators-stability") == before


def test_a_folder_that_cannot_be_written_to_is_a_usage_error(tmp_path):
    (tmp_path / "file").write_text("in the way", encoding="utf-8")
    with pytest.raises(UsageError, match="cannot be written"):
        registry.save("integrators-stability", tmp_path / "file")


def test_an_unknown_figure_is_not_found():
    with pytest.raises(NotFoundError, match="no figure 'nothing'"):
        registry.build("nothing")


def test_asking_which_figures_there_are_loads_no_matplotlib():
    code = (
        "import sys; from course.figures.registry import figure_ids;"
        "figure_ids(); print('matplotlib' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"
