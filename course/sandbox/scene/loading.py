"""Scenes from files: the course's own by id, a student's by path, with parameters set."""

import math
import re
from collections.abc import Iterator, Mapping
from decimal import Decimal
from pathlib import Path
from typing import Any

import msgspec

from course.catalog.locate import content
from course.catalog.reading import BLANK, Document, read_document, read_text
from course.errors import ContentError, NotFoundError, UsageError
from course.printable import meant
from course.sandbox.scene.expression import evaluate, fill, names, used
from course.sandbox.scene.model import Part, Prediction, Scene, layout
from course.sandbox.scene.rules import FIELDS, SETTINGS, check_scene, checked, number, settings_of, slot

#: The program's own scenes.
FOLDER = Path(__file__).parents[1] / "scenes"


#: Where the formula is that a run is compared with.
_THEORY = ("prediction", "theory")


class Chosen(msgspec.Struct, frozen=True, kw_only=True):
    """A scene with changed parameters and settings.

    Attributes:
        scene: with its parameters put in.
        parameters: the scene's own, every one.
        settings: those of ``SETTINGS`` that were given.
        own: it is not one of the course's.
    """

    scene: Scene
    parameters: dict[str, float]
    settings: dict[str, float]
    path: Path
    own: bool = False

    @property
    def present(self) -> dict[str, float]:
        """The settings in force: those that were given, and the scene's own."""
        return self.scene.settings | self.settings


def scene_ids() -> tuple[str, ...]:
    """Ids of the course's scenes, sorted; lists a folder and opens no file."""
    return tuple(sorted({path.stem for folder in scene_folders() for path in folder.glob("*.toml")}))


def scene_path(name: str) -> Path:
    """The file of one of the course's scenes."""
    paths = [folder / f"{name}.toml" for folder in scene_folders()]
    return next((path for path in paths if path.is_file()), paths[0])


def scene_folders() -> tuple[Path, ...]:
    """The program's own scenes, and those that a course adds."""
    more = content().scenes
    return (FOLDER,) if more is None else (FOLDER, more)


def scenes() -> tuple[Scene, ...]:
    """The course's scenes, in the order in which to play them.

    Raises:
        ContentError: one is wrong.
    """
    found = (read_scene(scene_path(name)) for name in scene_ids())
    return tuple(sorted(found, key=lambda scene: (scene.order, scene.id)))


def read_scene(path: Path) -> Scene:
    """One file.

    Raises:
        ContentError: it is missing or wrong; names the line and the fix.
    """
    document = _read(path)
    if document.value.id != path.stem:
        problem = f"the id is {document.value.id}, the file {path.name}."
        document.fail(("id",), problem, fix="Make them the same.")
    return document.value


def choose(name: str, settings: Mapping[str, object] | None = None) -> Chosen:
    """A scene by its id, or a file by its path, with parameters and settings.

    Args:
        name: an id of the course's scenes, its number in their list, or a path that ends in ``.toml``.
        settings: values for the scene's parameters, for ``seed``, and for ``SETTINGS``.

    Raises:
        NotFoundError: there is no such scene.
        UsageError: a student's file is wrong, or a parameter unknown or out of range.
        ContentError: one of the course's files is wrong.
    """
    if name.isdecimal() and 1 <= int(name) <= len(scene_ids()):
        name = scenes()[int(name) - 1].id
    own = name.endswith(".toml") or "/" in name
    path = Path(name).expanduser() if own else scene_path(name)
    if own and not path.exists():  # a pipe is no file, and can be read
        fix = "`course sandbox list` shows the scenes."
        raise NotFoundError(f"There is no file {path}.", help=fix, code="scene_not_found")
    if not own and name not in scene_ids():
        fix = meant(name, scene_ids(), "`course sandbox list` shows them.")
        if Path(f"{name}.toml").is_file():
            fix = f"Your own is a file: {name}.toml."
        raise NotFoundError(f"There is no scene called {name[:80]!r}.", help=fix, code="scene_not_found")
    try:
        scene = _read(path).value if own else read_scene(path)
    except ContentError as error:
        if not own:
            raise
        raise UsageError(error.message, help=error.help, code="bad_scene") from error
    return _put_in(scene, dict(settings or {}), path, own=own)


def values_of(chosen: Chosen) -> dict[str, float]:
    """The names that a formula of the scene may use: its parameters, ``g``, ``step``, fields of bodies."""
    scene, present = chosen.scene, chosen.present
    values = {name.replace("-", "_"): value for name, value in chosen.parameters.items()}
    values |= {key: present[key] for key in scene.settings if key != "gravity"}
    values["g"] = present["gravity"] or (scene.floor.gravity if scene.floor else 0.0)
    values["duration"] = scene.duration
    for part in layout(scene):
        name = part.name.replace("-", "_")
        own = {field: getattr(part, field) for field in FIELDS}
        own["restitution"], own["friction"] = surface_of(chosen, part)
        values |= {f"{name}.{field}": value for field, value in own.items()}
    return values


def surface_of(chosen: Chosen, part: Part) -> tuple[float, float]:
    """Restitution and friction of a body, with the settings if there are any."""
    if part.fixed:
        return part.restitution, part.friction
    settings = chosen.settings
    return settings.get("restitution", part.restitution), settings.get("friction", part.friction)


def unchanged(scene: Scene) -> Chosen:
    """One of the course's scenes, unchanged."""
    return _put_in(scene, {}, scene_path(scene.id))


def unsaid(scene: Scene) -> Iterator[str]:
    """Parameters and settings that change what theory gives, and no word of question and explanation."""
    usual, asked = unchanged(scene), scene.prediction
    if asked is None:
        return
    tried = {parameter.name: (parameter.default, parameter.high) for parameter in scene.parameter}
    changeable = (one for one in settings_of(scene) if one.name not in {"iterations", "walls", "seed"})
    tried |= {setting.name: (setting.low, setting.high) for setting in changeable}
    for name, (low, high) in tried.items():
        other = _put_in(scene, {name: low + 0.37 * (high - low)}, usual.path)
        before, now = (compare(asked, 0.0, values_of(one), None) for one in (usual, other))
        if now.theory != before.theory and (now.question, now.why) == (before.question, before.why):
            yield name


def with_settings(chosen: Chosen, settings: Mapping[str, float]) -> Chosen:
    """The same with the present settings of its world."""
    return msgspec.structs.replace(chosen, settings=dict(settings))


def question(chosen: Chosen) -> str:
    """The scene's question, with its numbers; "" if it has none.

    Raises:
        UsageError: a formula in it has no value for these settings.
    """
    asked = chosen.scene.prediction
    return "" if asked is None else fill(asked.question, values_of(chosen))


def own_copy(chosen: Chosen, id_: str) -> bytes:
    """The scene's file as somebody's own: another id, and its parameters as they are set now."""
    text = re.sub(r'(?m)^id = ".*"$', f'id = "{id_}"', read_text(chosen.path), count=1)
    for name, value in chosen.parameters.items():
        block = rf'(\[\[parameter\]\]\nname = "{re.escape(name)}"\n(?:(?!\[).*\n)*?default = ).*'
        text = re.sub(block, rf"\g<1>{value!r}", text, count=1)
    return text.encode()


def unwritten(path: Path) -> tuple[int, ...]:
    """The lines of a scene that its author still has to write; none where there is no file."""
    lines = read_text(path).split("\n") if path.is_file() else ()
    return tuple(number for number, line in enumerate(lines, start=1) if BLANK.search(line))


def _read(path: Path) -> Document[Scene]:
    # A scene runs while its words are still to be written, and nobody is to read an author's marks.
    document = read_document(path, Scene, text=BLANK.sub("(still to be written)", read_text(path)))
    check_scene(document)
    _check_formulas(document)
    return document


def _check_formulas(document: Document[Scene]) -> None:
    """Check that all formulas have values: for the scene as it is, and at both ends of each range."""
    scene = document.value
    texts: dict[tuple[str | int, ...], str] = {
        ("probe", i, "time"): f"{{{probe.time}}}"
        for i, probe in enumerate(scene.probe)
        if probe.time is not None
    }
    if scene.prediction is not None:
        texts |= {("prediction", key): getattr(scene.prediction, key) for key in ("question", "why")}
        texts[_THEORY] = f"{{{scene.prediction.theory}}}"
    named: set[str] = set()
    for where, text in texts.items():
        try:
            names_in = used(text)
        except UsageError as error:
            document.fail(where, error.message, fix=error.help)
        named |= {name.rpartition(".")[2] for name in names_in} if where != _THEORY else set()
    for settings in _ends(scene, named):
        try:
            chosen = _put_in(scene, dict(settings), document.path)
        except MisfitError as error:
            document.fail(("sets", error.place), error.message, fix=error.help)
        except UsageError as error:
            if settings:
                continue  # that end is out of reach; a user who asks for it is told so
            document.fail(("sets",), error.message, fix=error.help)
        values = values_of(chosen)
        for where, text in texts.items():
            if where == _THEORY and settings:
                continue  # it may end where a range does, and then there is nothing to compare
            try:
                fill(text, values)
                time = evaluate(text[1:-1], values) if where[-1] == "time" and not settings else None
            except UsageError as error:
                there = "".join(f" at {name}={value:g}" for name, value in settings.items())
                document.fail(where, f"{error.message.rstrip('.')}{there}.", fix=error.help)
            if time is not None and not 0.0 <= time <= scene.duration:
                problem = f"that is {time:g} s, which no run sees."
                document.fail(where, problem, fix="Make it 0 to `duration`, or make `duration` longer.")


def _ends(scene: Scene, named: set[str]) -> Iterator[dict[str, float]]:
    """No settings, then each alone at either end of its range, if formulas use these names."""
    yield {}
    ranged: list[Any] = [*scene.parameter]
    ranged += [one for one in SETTINGS.values() if {"gravity": "g"}.get(one.name, one.name) in named]
    for one in ranged:
        yield {one.name: one.low}
        yield {one.name: one.high}


def _put_in(scene: Scene, settings: dict[str, object], path: Path, *, own: bool = False) -> Chosen:
    """The scene with its parameters put in; the other settings go to the world."""
    parameters = {parameter.name: parameter for parameter in scene.parameter}
    seed = int(checked("seed", settings.pop("seed", scene.seed)))
    given = {name: value for name, value in settings.items() if name in parameters}
    rest = {name: value for name, value in settings.items() if name not in parameters}
    for name in rest:
        if name not in SETTINGS:
            known = ", ".join([*parameters, *(setting.name for setting in settings_of(scene))])
            raise UsageError(
                f"{scene.id} has no parameter called {name[:40]!r}.",
                help=f"Known: {known}.",
                code="bad_parameter",
            )
    raw: dict[str, Any] = msgspec.to_builtins(scene)
    values: dict[str, float] = {}
    for name, parameter in parameters.items():
        value = number(given.get(name, parameter.default), name)
        if not parameter.low <= value <= parameter.high:
            raise UsageError(
                f"{name} must be from {parameter.low:g} to {parameter.high:g}, and {value:g} is not.",
                help=f"{name}: {parameter.meaning}",
                code="bad_parameter",
            )
        values[name] = value
    numbers = {name.replace("-", "_"): value for name, value in values.items()}
    for place, formula in scene.sets.items():
        value = evaluate(formula, numbers)
        target, key = slot(raw, place)
        kind = type(target[key])
        target[key] = kind(value) if kind in {int, bool} else value  # whole numbers stay whole
        try:
            msgspec.convert(raw, Scene)
        except msgspec.ValidationError as error:
            allowed = str(error).partition(" - at ")[0].partition("` ")[2] or "of another kind"
            where = ", ".join(f"{name}={numbers[name]:g}" for name in sorted(names(formula)))
            raise MisfitError(
                place,
                f"With {where}, {place} is {value:g}, and must be {allowed}.",
                f"Choose other values, or correct its formula, {formula}.",
            ) from error
    ready = msgspec.convert(raw | {"seed": seed}, Scene)
    checked_rest = {name: checked(name, value) for name, value in rest.items()}
    return Chosen(scene=ready, parameters=values, settings=checked_rest, path=path, own=own)


class MisfitError(UsageError):
    """A formula of ``[sets]`` gives a value that its place does not take.

    Attributes:
        place: which, as it stands there.
    """

    def __init__(self, place: str, message: str, help_: str) -> None:
        super().__init__(message, help=help_, code="bad_parameter")
        self.place = place


# ---
# Predict, run, compare: a guess, a formula and a simulation side by side.


#: How a guess may be written, and what is said of a text that is none.
GUESS_LIKE = "Try something like 2.5 (or 2,5) or -1e3, in the unit of the question."
NO_GUESS = f"This is not a number, or one too large. {GUESS_LIKE}"


class Comparison(msgspec.Struct, frozen=True, kw_only=True):
    """The three numbers.

    Attributes:
        question, unit: as the scene asks, with the numbers of this run.
        guess: the student's; None if none was made.
        simulation: what the run gave; "nan" if what was asked for did not happen.
        guess_right: the guess is theory or simulation, but for rounding; None without a guess.
        agree: theory and simulation are as close as the scene says they should be.
        why: the reasoning behind the formula, with the numbers of this run.
    """

    question: str
    unit: str
    guess: float | None
    theory: float
    simulation: float
    guess_right: bool | None
    agree: bool
    verdict: str
    why: str


def guess_of(text: str, unit: str) -> float | None:
    """The number in a typed text, with comma or point, with its unit or without; None if there is none."""
    try:
        value = float(text.strip().removesuffix(unit).replace(",", "."))
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def compare(
    asked: Prediction, simulation: float, values: Mapping[str, float], guess: float | None, whole: float = 0.0
) -> Comparison:
    """Put guess, theory and simulation side by side.

    Args:
        asked: the scene's question.
        guess: the student's number.
        whole: how long the scene takes, in s; a run that was cut short of it need not agree.

    Raises:
        UsageError: the formula, or one in the texts, has no value for these parameters.
    """
    theory = evaluate(asked.theory, values)
    compared = Comparison(
        question=fill(asked.question, values),
        unit=asked.unit,
        guess=guess,
        theory=theory,
        simulation=simulation,
        guess_right=None if guess is None else _is_right(guess, theory) or _is_right(guess, simulation),
        agree=abs(simulation - theory) <= max(asked.agrees * abs(theory), asked.agrees_abs),
        verdict="",
        why=fill(asked.why, values),
    )
    ran = values.get("duration", whole)
    cut = f"after {ran:g} s of the scene's {whole:g}" if ran < whole * (1 - 1e-6) else ""
    return msgspec.structs.replace(compared, verdict=_verdict(asked, compared, cut))


def _verdict(asked: Prediction, compared: Comparison, cut: str) -> str:
    guess, theory, simulation = compared.guess, compared.theory, compared.simulation
    if math.isnan(simulation):
        return "What the question asks about did not happen in this run."
    if compared.agree:
        text = "Theory and simulation agree."
    elif cut:
        text = f"The run ended {cut}, perhaps before what the question asks about was over."
    else:
        text = (
            "Theory and simulation do not agree here: one of them leaves something out. "
            "Look for what, and which of the two speaks of the world."
        )
    if guess is None:
        return text
    answer = simulation if abs(guess - simulation) < abs(guess - theory) else theory
    by = "" if compared.agree else f" by the {'theory' if answer == theory else 'simulation'}"
    if compared.guess_right:
        return f"Your guess is right{by}. {text}"
    is_close = abs(guess - answer) <= max(asked.near * abs(answer), asked.near_abs)
    answer = answer if is_close else theory
    off = guess - answer
    said = f"off by {abs(off):.3g} {'' if asked.unit == '1' else asked.unit}".rstrip()
    if answer * guess > 0.0:
        percent = 100 * abs(off / answer)
        said = f"{percent:.{0 if percent >= 1 else 1}f} % too {'high' if off > 0 else 'low'}"
    return f"Your guess is {f'close{by}: ' if is_close else ''}{said}. {text}"


#: However few digits a guess has, it is right only this close to the answer, as a fraction of it.
_ROUNDED = 0.02


def _is_right(guess: float, answer: float) -> bool:
    """Whether a guess is the answer, rounded to the digits that it has."""
    places = Decimal(repr(guess)).normalize().as_tuple().exponent
    half = 0.5 * 10.0 ** min(int(places), 0)
    return abs(guess - answer) <= max(min(half, _ROUNDED * abs(answer)), 1e-12)
