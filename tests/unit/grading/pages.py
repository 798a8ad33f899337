"""Reads an HTML page strictly: whatever a browser would forgive is an error here."""

import itertools
import re
from html.parser import HTMLParser

_VOID = {"br", "hr", "img", "input", "link", "meta"}
_HEADINGS = ["h1", "h2", "h3", "h4"]


class Page(HTMLParser):
    """A page taken apart.

    Attributes:
        text: all text outside of style and script, a line per piece.
        tables: caption -> rows of cells' texts, the headings first.
        elements: name and attributes, in order.
    """

    def __init__(self, source):
        super().__init__(convert_charrefs=True)
        self.source = source
        self.elements = []
        self.faults = []
        self.pieces = []
        self.tables = {}
        self._open = []
        self._rows = []
        self._caption = ""
        self.feed(source)
        self.close()
        self.faults += [f"<{name}> is not closed" for name in self._open]

    @property
    def text(self):
        return "\n".join(self.pieces)

    def all(self, name):
        return [attributes for tag, attributes in self.elements if tag == name]

    def handle_starttag(self, tag, attrs):
        if len({name for name, _ in attrs}) < len(attrs):
            self.faults.append(f"<{tag}> has an attribute twice")
        self.elements.append((tag, dict(attrs)))
        if tag == "table":
            self._rows, self._caption = [], ""
        elif tag == "tr":
            self._rows.append([])
        elif tag in {"th", "td"}:
            self._rows[-1].append("")
        if tag not in _VOID:
            self._open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))
        if "svg" not in self._open:
            self.faults.append(f"<{tag}/> outside of a drawing")

    def handle_endtag(self, tag):
        if not self._open or self._open[-1] != tag:
            self.faults.append(f"</{tag}> closes {self._open[-1:]}")
            return
        self._open.pop()
        if tag == "table" and self._caption:
            self.tables[self._caption] = self._rows

    def handle_data(self, data):
        if self._open and self._open[-1] in {"style", "script"}:
            return
        self.pieces.append(data)
        if "caption" in self._open:
            self._caption += data
        elif {"th", "td"} & set(self._open):
            row = self._rows[-1]
            row[-1] = f"{row[-1]} {data}".strip()

    def unknown_decl(self, data):
        self.faults.append(f"a declaration: {data[:40]}")


def read_page(path):
    return Page(path.read_text("utf-8"))


def faults(page, *, scripted):
    """What is wrong with a page that everybody must be able to read, and that nobody may attack."""
    found = list(page.faults)
    names = [name for name, _ in page.elements]
    found += [f"{names.count(name)} of <{name}>" for name in ("h1", "main", "title", "header", "html")
              if names.count(name) - (name == "header") * names.count("article") != 1]  # fmt: skip
    levels = [_HEADINGS.index(name) for name in names if name in _HEADINGS]
    found += ["a heading skips a level" for a, b in itertools.pairwise(levels) if b > a + 1]
    anchors = [attributes["id"] for _, attributes in page.elements if "id" in attributes]
    found += ["an id twice"] * (len(set(anchors)) < len(anchors))
    for name, attributes in page.elements:
        found += [f"{key} on <{name}>" for key in attributes if key.startswith("on") or key == "srcset"]
        href = attributes.get("href")
        if href and href.startswith("#") and href[1:] not in anchors:
            found.append(f"{href} leads nowhere")
        if href and not re.fullmatch(r"#[a-z0-9-]+|students/[1-9]\d*\.html|[a-z-]+\.html", href):
            found.append(f"a link to {href[:80]}")
        if "src" in attributes or name in {"img", "iframe", "object", "link", "base", "form"}:
            found.append(f"<{name}> loads or sends")
        if name == "th" and attributes.get("scope") not in {"row", "col"}:
            found.append("<th> without scope")
        if name == "svg" and not (attributes.get("aria-label") or attributes.get("aria-hidden") == "true"):
            found.append("a drawing without words")
    if names.count("script") != scripted:
        found.append("a script")
    if "lang" not in page.all("html")[0]:
        found.append("no language")
    return found
