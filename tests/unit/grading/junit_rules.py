"""What Jenkins' xUnit plugin accepts as JUnit XML (its schema junit-10), as a table and a checker.

Written from the schema's rules and checked against the schema itself with a validating parser; the schema is
not part of this project.
"""

from __future__ import annotations

import re
from xml.etree import ElementTree as ET

_DETAIL = ({"type", "message"}, set(), set())
#: element -> attributes it may have, those it must have, children it may have
RULES: dict[str, tuple[set[str], set[str], set[str]]] = {
    "testsuites": ({"name", "time", "tests", "failures", "errors"}, set(), {"testsuite"}),
    "testsuite": (
        {
            "name", "tests", "failures", "errors", "group", "time", "skipped", "timestamp", "hostname", "id",
            "package", "file", "log", "url",
        },
        {"name", "tests", "failures", "errors"},
        {"testsuite", "properties", "testcase", "system-out", "system-err"},
    ),
    "testcase": (
        {"name", "time", "classname", "group"},
        {"name"},
        {"skipped", "error", "failure", "system-out", "system-err"},
    ),
    "properties": (set(), set(), {"property"}),
    "property": ({"name", "value"}, {"name", "value"}, set()),
    "failure": _DETAIL,
    "error": _DETAIL,
    "skipped": _DETAIL,
    "system-out": (set(), set(), set()),
    "system-err": (set(), set(), set()),
}  # fmt: skip
#: Elements that may hold text beside their children.
MIXED = {"failure", "error", "skipped", "system-out", "system-err"}
_TIME = re.compile(r"(([0-9]{0,3},)*[0-9]{3}|[0-9]{0,3})*(\.[0-9]*)?")


def violations(content: bytes) -> list[str]:
    """What the schema would complain about; raises where it is not XML at all."""
    root = ET.fromstring(content)
    found = [] if root.tag in RULES else [f"root {root.tag}"]
    for element in root.iter():
        if element.tag not in RULES:
            found.append(f"unknown element {element.tag}")
            continue
        may, must, children = RULES[element.tag]
        found += [f"{element.tag} has attribute {name}" for name in set(element.keys()) - may]
        found += [f"{element.tag} lacks attribute {name}" for name in must - set(element.keys())]
        found += [f"{element.tag} has child {child.tag}" for child in element if child.tag not in children]
        if element.tag in {"testsuite", "testsuites"} and not _TIME.fullmatch(element.get("time", "")):
            found.append(f"{element.tag} has time {element.get('time')}")
        if element.tag not in MIXED:
            texts = [element.text, *(child.tail for child in element)]
            found += [f"text in {element.tag}" for text in texts if (text or "").strip()]
    return found
