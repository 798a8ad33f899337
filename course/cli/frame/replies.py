"""The replies of ``--json``, as types; scripts depend on every name here.

Each answer is one struct whose tag is its schema, ``course.<command>/1``. A field may be added within a
version; renaming, removing or changing the meaning of one makes a new version.
"""

from __future__ import annotations

import json
import re
from typing import Any, ClassVar, TypeVar

import msgspec

from course.scoring.verdict import finite

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


def encode(body: msgspec.Struct) -> bytes:
    """``body`` as one line of JSON in UTF-8; numbers that JSON has not are "nan", "inf" and "-inf".

    The bytes of a name that are no text are spelled out.
    """
    plain = finite(msgspec.to_builtins(body))
    try:
        return msgspec.json.encode(plain)
    except UnicodeEncodeError:
        text = json.dumps(plain, ensure_ascii=False)
        return re.sub("[\ud800-\udfff]", lambda half: rf"\\u{ord(half[0]):x}", text).encode("utf-8")
