"""The replies of ``--json``, as types, and ``course schema``; scripts depend on every name here.

Each answer is one struct whose tag is its schema, ``course.<command>/1``. A field may be added within a
version; renaming, removing or changing the meaning of one makes a new version.
"""

from typing import Annotated, Any, ClassVar, TypeVar

import msgspec

from course.cli.frame.console import current
from course.cli.frame.options import Line, argument
from course.cli.frame.registry import COMMANDS, find
from course.errors import NotFoundError

_Kind = TypeVar("_Kind", bound=msgspec.Struct)


class NextStep(msgspec.Struct, frozen=True):
    """The command to run next."""

    command: str


class ErrorBody(msgspec.Struct, frozen=True):
    """A stable code, what is wrong, and what to do about it."""

    code: str
    message: str
    help: str = ""


class Envelope(msgspec.Struct, frozen=True, kw_only=True, tag_field="schema"):
    """The fields that every reply begins with.

    Attributes:
        refers_to: structs that its schema names and msgspec does not see.
    """

    refers_to: ClassVar[tuple[type[msgspec.Struct], ...]] = ()

    ok: bool = True
    exit_code: int = 0

    def __post_init__(self) -> None:
        """``ok`` is "the exit code is 0" in every reply."""
        msgspec.structs.force_setattr(self, "ok", self.exit_code == 0)


class ErrorReply(msgspec.Struct, frozen=True, kw_only=True):
    """The answer of a command that could not do its work; its schema is the command's own."""

    schema: str
    ok: bool = False
    exit_code: int
    error: ErrorBody


class Version(Envelope, tag="course.version/1", frozen=True, kw_only=True):
    version: str
    python: str


class Help(Envelope, tag="course.help/1", frozen=True, kw_only=True):
    text: str


class Schemas(Envelope, tag="course.schema-list/1", frozen=True, kw_only=True):
    """Which schemas there are."""

    schemas: tuple[str, ...]


class Schema(Envelope, tag="course.schema/1", frozen=True, kw_only=True):
    """The JSON Schema of one kind of reply."""

    name: str
    document: dict[str, Any]


class Bare(msgspec.Struct, frozen=True, kw_only=True):
    """The answer of a command that had nothing to report beyond its exit code."""

    schema: str
    ok: bool
    exit_code: int


class FileReply(msgspec.Struct, frozen=True):
    """A file and what was done about it."""

    path: str
    action: str


class Backup(msgspec.Struct, frozen=True):
    """A file that was replaced and where its copy is."""

    path: str
    backup: str


class WrittenFile(msgspec.Struct, frozen=True):
    """A file that was written, and the copy of what was there before."""

    path: str
    backup: Backup | None = None


def filled(kind: type[_Kind], /, *sources: object, **given: Any) -> _Kind:
    """A reply from the objects that it describes.

    Args:
        sources: a field is what the first of them has under the field's name, just as it is.
        given: the fields that are called otherwise there, or are not there.
    """
    found = dict(given)
    for name in kind.__struct_fields__:
        for source in sources if name not in given else ():
            if hasattr(source, name):
                found[name] = getattr(source, name)
                break
    return kind(**found)


# ---
# Their JSON Schemas.


#: The reply to a line without a known command: an error.
NO_COMMAND = "course.error/1"

_DIALECT = "https://json-schema.org/draft/2020-12/schema"
#: JSON has no such numbers, so replies spell them.
_NUMBER = {"anyOf": [{"type": "number"}, {"enum": ["nan", "inf", "-inf"]}]}


def schema_names(incomplete: str) -> list[str]:
    """Kinds of replies whose name begins with what was typed."""
    return sorted(name for name in map(_short, reply_types()) if name.startswith(incomplete))


def schema(
    name: Annotated[
        str | None, argument("NAME", "Of a reply; the list of them if left out.", schema_names)
    ] = None,
) -> int:
    """Print the JSON Schema of a reply.

    Each reply names its schema: "course.check/1" is "check" here. Within a version fields may be added;
    renaming or removing one, or changing what it means, makes a new version, and the CHANGELOG says so.
    """
    console, found = current(), tuple(reply_types())
    if name is None:
        console.table(("Name", "Schema"), [(_short(tag), tag) for tag in found])
        return console.answer(Schemas(schemas=found))
    tag = next((tag for tag in found if name in {tag, _short(tag)}), None)
    if tag is None:
        problem = f"There is no reply called {name[:80]!r}."
        raise NotFoundError(problem, help="`course schema` lists them.", code="schema_not_found")
    document = schema_of(tag)
    console.raw(msgspec.json.format(msgspec.json.encode(document), indent=2).decode() + "\n")
    return console.answer(Schema(name=tag, document=document))


def reply_types() -> dict[str, type[msgspec.Struct]]:
    """Every kind of reply by its schema's name, sorted."""
    from course.grading.exports.grades import GradeLine

    for entry in COMMANDS.values():
        find(entry.module, entry.name)
    kinds: list[type[msgspec.Struct]] = [*Envelope.__subclasses__(), GradeLine]
    found = {str(kind.__struct_config__.tag): kind for kind in kinds} | {NO_COMMAND: ErrorReply}
    return dict(sorted(found.items()))


def schema_of(tag: str) -> dict[str, Any]:
    """The JSON Schema of a reply: what the command answers, or why it could not."""
    kind = reply_types()[tag]
    names = [kind, ErrorReply, Bare, *getattr(kind, "refers_to", ())]
    (answer, *without), definitions = msgspec.json.schema_components(names, ref_template="#/$defs/{name}")
    for name in (ErrorReply.__name__, Bare.__name__):
        # Otherwise any reply would match one of these, with something added.
        definitions[name]["additionalProperties"] = False
    named = {"properties": {"schema": {"const": tag}}}
    return {
        "$schema": _DIALECT,
        "$id": tag,
        "title": tag,
        "anyOf": [answer | named, *(one | named for one in without[:2])],
        "$defs": _with_spelt_numbers(definitions),
    }


def schema_of_line(line: Line) -> str:
    """The schema's name of what a command line answers, for when it has no answer."""
    words = [word for word in line.rest if not word.startswith("-")]
    if not words:
        words = ["version" if line.version else "status"]
    known = {_short(tag): tag for tag in reply_types()}
    wanted = [*([f"{words[0]}-all"] if "--all" in line.rest else ()), "-".join(words[:2]), words[0]]
    return next((known[name] for name in wanted if name in known), NO_COMMAND)


def _short(tag: str) -> str:
    return tag.removeprefix("course.").partition("/")[0]


def _with_spelt_numbers(value: Any) -> Any:
    if isinstance(value, dict):
        if value == {"type": "number"}:
            return _NUMBER
        changed = {key: _with_spelt_numbers(item) for key, item in value.items()}
        if changed.get("type") == "number":
            return {**{key: item for key, item in changed.items() if key != "type"}, **_NUMBER}
        return changed
    return [_with_spelt_numbers(item) for item in value] if isinstance(value, list) else value
