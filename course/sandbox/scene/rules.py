"""The rules for a scene that its types cannot express: references, complete shapes, fitting ranges."""

import math
from dataclasses import dataclass
from typing import Any, get_args

import msgspec

from course.catalog.reading import Document
from course.errors import UsageError
from course.sandbox.scene import expression
from course.sandbox.scene.model import Body, OfMany, Probe, Scene, Shape, layout, signed_area

# ---
# The settings that can be changed in any running world, and their ranges.


@dataclass(frozen=True, slots=True)
class Setting:
    """A number that every world has.

    Attributes:
        low, high: the range, both included.
        notch: how much one key press or one step of a slider changes it; a factor if ``times``.
    """

    name: str
    unit: str
    meaning: str
    low: float
    high: float
    notch: float
    times: bool = False
    whole: bool = False


_OF_BODIES = "of every movable body; fixed ones keep theirs, pairs multiply"
SETTINGS: dict[str, Setting] = {
    s.name: s
    for s in (
        Setting("gravity", "m/s²", "size of gravity; its direction is the scene's", 0.0, 100.0, 0.5),
        Setting("restitution", "1", _OF_BODIES, 0.0, 1.0, 0.05),
        Setting("friction", "1", _OF_BODIES, 0.0, 10.0, 0.05),
        Setting("step", "s", "size of the time step", 1e-5, 0.1, 2.0, times=True),
        Setting(
            "iterations", "1", "of the contact solver in each step", 1, 1000, 2.0, times=True, whole=True
        ),
        Setting("walls", "1", "1 puts walls around what is shown", 0, 1, 1.0, whole=True),
        Setting("left", "m/s", "rim speed of the left wheel, in scenes with wheels", -5.0, 5.0, 0.1),
        Setting("right", "m/s", "rim speed of the right wheel, in scenes with wheels", -5.0, 5.0, 0.1),
    )
}

SEED = Setting("seed", "1", "of the places that are drawn at random", 0, 1e9, 1.0, whole=True)


def settings_of(scene: Scene) -> tuple[Setting, ...]:
    """The settings that do something in this scene."""
    found = tuple(s for s in SETTINGS.values() if s.name in scene.settings or s.name not in {"left", "right"})
    return (*found, SEED) if any(body.jitter for body in scene.body) else found


def checked(key: str, value: object) -> float:
    """A value for a setting.

    Raises:
        UsageError: there is no such setting, or the value is not a number in its range.
    """
    setting = SEED if key == SEED.name else SETTINGS.get(key)
    if setting is None:
        raise UsageError(
            f"There is no setting called {str(key)[:40]!r}.",
            help=f"Settings: {', '.join(SETTINGS)}.",
            code="bad_parameter",
        )
    amount = number(value, key)
    if not setting.low <= amount <= setting.high or (setting.whole and amount != round(amount)):
        kind = "a whole number" if setting.whole else "a number"
        raise UsageError(
            f"{key} must be {kind} from {setting.low:,.10g} to {setting.high:,.10g}, "
            f"and {amount:,.10g} is not.",
            help=f"{key}: {setting.meaning}.",
            code="bad_parameter",
        )
    return amount


def number(value: object, what: str) -> float:
    """A finite number.

    Raises:
        UsageError: it is none.
    """
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise UsageError(f"{what} must be a finite number, not {str(value)[:40]}.", code="bad_parameter")
    return float(value)


#: The fields that ``body.field`` may name in a formula.
FIELDS = ("x", "y", "vx", "vy", "mass", "radius", "restitution", "friction")

_NEEDS: dict[Shape, tuple[str, ...]] = {
    "circle": ("radius",),
    "box": ("size",),
    "polygon": ("points",),
    "segment": ("points", "thickness"),
}
_SHAPE_KEYS = ("radius", "size", "points", "thickness")
_MOST = 1000


def check_scene(document: Document[Scene]) -> None:
    """Raises ContentError, with the line, for the first thing that is wrong."""
    scene = document.value
    left, bottom, right, top = scene.view
    if left >= right or bottom >= top:
        document.fail(("view",), "the view is empty.", fix="Write left, bottom, right, top, smallest first.")
    _check_bodies(document)
    _check_joints(document)
    _check_parameters(document)
    _check_probes(document)
    _check_prediction(document)


def matching(pattern: str, names: tuple[str, ...]) -> tuple[str, ...]:
    """The names a pattern means; one without ``*`` means itself."""
    if pattern.endswith("*"):
        return tuple(name for name in names if name.startswith(pattern[:-1]))
    return tuple(name for name in names if name == pattern)


def _check_bodies(document: Document[Scene]) -> None:
    scene = document.value
    seen: dict[str, int] = {}
    total = 0
    if len(scene.materials) < len(scene.material):
        document.fail(("material",), "two materials have the same name.", fix="Rename one.")
    for i, body in enumerate(scene.body):
        where = ("body", i)
        if body.name in seen:
            document.fail(
                (*where, "name"),
                f"the name {body.name} is taken by body {seen[body.name] + 1}.",
                fix="Name each body differently; `repeat` makes copies.",
            )
        seen[body.name] = i
        if body.material not in scene.materials:
            document.fail(
                (*where, "material"),
                f"there is no material called {body.material}.",
                fix=f"Materials: {', '.join(scene.materials)}.",
            )
        _check_shape(document, i, body)
        total += math.prod(repeat.count for repeat in body.repeat)
    if total > _MOST:
        document.fail(("body",), f"there are {total} bodies.", fix=f"Keep to {_MOST}.")
    names = [part.name for part in layout(scene)]
    for name in names:
        if names.count(name) > 1:
            document.fail(
                ("body",), f"two bodies are called {name}.", fix="A copy is called name-1, name-2 ..."
            )


def _check_shape(document: Document[Scene], i: int, body: Body) -> None:
    where = ("body", i)
    for key in _NEEDS[body.shape]:
        if getattr(body, key) is None:
            document.fail(
                where, f"{body.name} is a {body.shape} and lacks `{key}`.", fix=f"Add `{key} = ...`."
            )
    for key in _SHAPE_KEYS:
        if getattr(body, key) is not None and key not in _NEEDS[body.shape]:
            document.fail((*where, key), f"a {body.shape} has no {key}.", fix="Remove the line.")
    if body.shape == "segment":
        if not body.fixed:
            document.fail(
                where, f"{body.name} is a segment and not fixed.", fix="Add `fixed = true`, or use a box."
            )
        if len(body.points or ()) != 2 or (body.points or ())[0] == (body.points or ())[1]:
            document.fail(
                (*where, "points"), "a segment has two different ends.", fix="Write [[x, y], [x, y]]."
            )
    if body.shape == "polygon" and not _is_convex(body.points or ()):
        document.fail(
            (*where, "points"),
            "the polygon is not convex, or its corners are not in order.",
            fix="List at least three corners in order around it; split a hollow shape into several bodies.",
        )
    if body.fixed:
        _check_fixed(document, i, body)


def _check_fixed(document: Document[Scene], i: int, body: Body) -> None:
    where = ("body", i)
    for key in ("mass", "wheels"):
        if getattr(body, key) is not None:
            document.fail((*where, key), f"{body.name} is fixed and needs no {key}.", fix="Remove the line.")
    if body.velocity != (0.0, 0.0) or body.spin:
        document.fail(where, f"{body.name} is fixed and cannot move.", fix="Remove its velocity and spin.")


def _is_convex(points: tuple[tuple[float, float], ...]) -> bool:
    if len(points) < 3:
        return False
    turned = 0.0
    ordered = points if signed_area(points) > 0 else points[::-1]
    for i in range(len(ordered)):
        (x0, y0), (x1, y1), (x2, y2) = (ordered[(i + k) % len(ordered)] for k in range(3))
        cross = (x1 - x0) * (y2 - y1) - (y1 - y0) * (x2 - x1)
        if cross <= 0.0:
            return False
        turned += math.atan2(cross, (x1 - x0) * (x2 - x1) + (y1 - y0) * (y2 - y1))
    return abs(turned - 2 * math.pi) < 1e-6  # a star goes round twice


def _check_joints(document: Document[Scene]) -> None:
    parts = layout(document.value)
    names = {part.name for part in parts}
    fixed = {part.name for part in parts if part.fixed}
    for i, joint in enumerate(document.value.joint):
        for side in ("a", "b"):
            name = getattr(joint, side)
            if name not in names:
                document.fail(("joint", i, side), f"there is no body called {name}.", fix=_known(names))
        if joint.a == joint.b:
            document.fail(
                ("joint", i), "a joint needs two bodies.", fix="To hang it up, join it to a fixed body."
            )
        if joint.b in fixed and joint.a in fixed:
            document.fail(
                ("joint", i), "neither end of this joint can move.", fix="Join something that moves."
            )


def _check_parameters(document: Document[Scene]) -> None:
    scene = document.value
    seen: set[str] = set()
    for i, parameter in enumerate(scene.parameter):
        where = ("parameter", i)
        if parameter.name in seen or parameter.name in SETTINGS or parameter.name == SEED.name:
            document.fail((*where, "name"), f"the name {parameter.name} is taken.", fix="Choose another.")
        seen.add(parameter.name)
        if not parameter.low <= parameter.default <= parameter.high:
            document.fail((*where, "default"), "the default is outside low to high.", fix="Widen the range.")
    known = {parameter.name.replace("-", "_") for parameter in scene.parameter}
    moved: set[str] = set()
    for place, formula in scene.sets.items():
        if not _can_be_set(scene, place):
            document.fail(("sets", place), f"{place} cannot be set.", fix="Write body.field or a field.")
        used = _names(document, ("sets", place), formula)
        if not used <= known:
            document.fail(
                ("sets", place), f"the formula uses {min(used - known)}.", fix="It may use parameters only."
            )
        moved |= used
    for i, probe in enumerate(scene.probe):
        if isinstance(probe.time, str):
            moved |= _names(document, ("probe", i, "time"), probe.time)
    for i, parameter in enumerate(scene.parameter):
        if parameter.name.replace("-", "_") not in moved:
            document.fail(
                ("parameter", i),
                f"nothing in the run depends on {parameter.name}.",
                fix="Use it in a formula of [sets], or take it out.",
            )


def slot(raw: Any, place: str) -> tuple[Any, Any]:
    """Where a formula's number goes in a scene made of plain data: what it is in, and its key there.

    Args:
        place: ``body.field``, ``body.field.0``, the same of a joint, or ``field``.

    Raises:
        LookupError, TypeError, ValueError: there is no such place.
    """
    steps: list[Any] = [int(step) if step.isdigit() else step for step in place.split(".")]
    named = {thing["name"]: thing for thing in (*raw["body"], *raw["joint"])}
    if len(steps) > 1 and steps[0] in named:
        raw, steps = named[steps[0]], steps[1:]
    for step in steps[:-1]:
        if isinstance(raw[step], tuple):
            raw[step] = list(raw[step])
        raw = raw[step]
    return raw, steps[-1]


def _can_be_set(scene: Scene, place: str) -> bool:
    """Whether a place holds a number."""
    try:
        target, key = slot(msgspec.to_builtins(scene), place)
        return isinstance(target[key], int | float)
    except (LookupError, TypeError, ValueError):
        return False


def _names(document: Document[Scene], where: tuple[str | int, ...], formula: str) -> frozenset[str]:
    try:
        return expression.names(formula)
    except UsageError as error:
        document.fail(where, error.message, fix=error.help)


def _check_probes(document: Document[Scene]) -> None:
    names = tuple(part.name for part in layout(document.value))
    seen: set[str] = set()
    for i, probe in enumerate(document.value.probe):
        where = ("probe", i)
        if probe.name in seen:
            document.fail((*where, "name"), f"there are two probes called {probe.name}.", fix="Rename one.")
        seen.add(probe.name)
        for key in ("of", "other"):
            pattern = getattr(probe, key)
            if pattern is not None and not matching(pattern, names):
                document.fail((*where, key), f"there is no body called {pattern}.", fix=_known(set(names)))
        _check_probe(document, i, probe, len(matching(probe.of, names)))


def _check_probe(document: Document[Scene], i: int, probe: Probe, bodies: int) -> None:
    where = ("probe", i)
    if (probe.when == "at") != (probe.time is not None):
        document.fail(where, 'a probe needs `time` exactly when `when` is "at".', fix="Add it, or remove it.")
    if (probe.quantity == "count") != (probe.region is not None):
        document.fail(
            where, "a probe needs `region` exactly when it is a count.", fix="Add it, or remove it."
        )
    if probe.when == "after" and probe.other is None:
        document.fail(where, "after which contact?", fix="Name the partner with `other`.")
    if bodies > 1 and probe.quantity not in get_args(OfMany):
        document.fail((*where, "of"), f"{probe.quantity} is of one body.", fix="Name one.")


def _check_prediction(document: Document[Scene]) -> None:
    scene = document.value
    asked = scene.prediction
    if asked is None:
        return
    if asked.probe not in {probe.name for probe in scene.probe}:
        document.fail(("prediction", "probe"), f"there is no probe called {asked.probe}.", fix="Add it.")
    if not asked.agrees and not asked.agrees_abs:
        document.fail(
            ("prediction",), "how far may theory be off?", fix="Add `agrees` (a fraction) or `agrees_abs`."
        )


def _known(names: set[str]) -> str:
    shown = sorted(names)
    return f"Bodies: {', '.join(shown[:12])}{' ...' if len(shown) > 12 else ''}."
