"""The page of ``course grade similar``: one file, no script, nothing from elsewhere."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from course.grading.exports.html_report.markup import (
    Html,
    joined,
    name_of,
    region_table,
    tag,
    text,
)
from course.grading.exports.html_report.markup import (
    page as whole_page,
)

if TYPE_CHECKING:
    from collections.abc import Iterable

    from course.grading.exports.html_report.markup import Heading
    from course.grading.similar.compare import Document, Pair, Similar

    #: First and last line.
    Passage = tuple[int, int]

__all__ = ["page"]

#: Blank lines that style guides put between two functions.
_BLANK = 2

#: Beside the style that all pages have. On paper, what is open is what somebody wants to talk about.
_STYLE: Final = """
body { max-width: 90rem; }
details.pair { border-top: 1px solid var(--line); margin: 0; padding: .6rem 0; }
.pair summary { color: inherit; font-size: 1rem; }
.pair summary h3 { color: var(--link); display: inline; margin: 0; }
.sides { display: grid; gap: .5rem 1.5rem; }
.sides { grid-template-columns: repeat(auto-fit, minmax(min(100%, 30rem), 1fr)); }
.sides > * { min-width: 0; }
.sides h4 { margin-top: .8rem; }
.sides pre { padding-left: .4rem; }
.sides pre > span { display: block; min-height: 1.45em; padding-left: 5.4em; text-indent: -5.4em; }
.sides b { color: var(--soft); display: inline-block; font-weight: 400; min-width: 5.4em; text-indent: 0; }
.sides b { user-select: none; white-space: pre; } .sides b a + a { margin-left: .4em; }
.alike { background: #ffe9a8; box-shadow: inset .25rem 0 0 #8a5300; color: #1b1f27; }
.alike b { color: #3d4450; } .alike a { color: #0b57a8; }
@media screen and (prefers-color-scheme: dark) {
  .alike { background: #4a3a10; box-shadow: inset .25rem 0 0 #f2c063; color: #f5ead0; }
  .alike b { color: #dccfa8; } .alike a { color: #a9cdf8; }
}
:target { scroll-margin-top: 4rem; }
@media (max-width: 32rem) {
  .sides pre > span { padding-left: 4.4em; text-indent: -4.4em; } .sides b { min-width: 4.4em; }
}
@media print {
  details.pair { display: block; } details.pair:not([open]), .on-screen { display: none; }
  .sides { display: flow-root; } .sides > div { float: left; width: 49%; }
  .sides > div + div { margin-left: 2%; }
  .sides pre { border: 0; font-size: 7.5pt; }
  .alike { background: #e4e4e4; box-shadow: inset .25rem 0 0 #555; print-color-adjust: exact; }
}
"""


def page(found: Similar) -> str:
    """The whole page."""
    about = tag(
        "p",
        f"{found.compared} submissions were compared with each other, with the model solution and with the"
        " course's own code, on this machine. Names, comments and layout do not count, nor does what the stub"
        " gave. A short exercise has few ways to be right: likeness is a reason to talk, not a finding.",
    )
    header = Html(tag("h1", "Similar submissions") + about)
    if found.pairs:
        rows = [_row(number, pair) for number, pair in enumerate(found.pairs, 1)]
        headings: list[Heading] = ["Pair", "Exercise", ("Share", "n"), ("Lines alike", "n")]
        main = region_table("Pairs, the most alike first", headings, rows) + _side_by_side(found)
    else:
        main = tag("p", "No two submissions are alike enough to be listed.")
    if found.left_out:
        main += tag("p", f"{found.left_out} more pairs are alike; raise --share or choose --exercise.")
    if found.unreadable:
        listed = joined(tag("li", name_of(entry)) for entry in found.unreadable)
        main += tag("h2", "Not compared: no Python") + tag("ul", listed)
    footer = tag(
        "p",
        "Share: how much of the smaller submission the other has too; what few have counts more than what"
        " many have. This page is the instructor's: it has names and work of students.",
    )
    nothing = Html("")
    return whole_page(
        "Similar submissions", header, nothing, Html(main), footer, scripted=False, style=_STYLE
    )


def _row(number: int, pair: Pair) -> Html:
    return tag(
        "tr",
        tag("th", tag("a", *_names(pair), href=f"#pair-{number}"), scope="row"),
        tag("td", pair.exercise),
        tag("td", _percent(pair), class_="n"),
        tag("td", str(pair.lines), class_="n"),
    )


def _names(pair: Pair) -> tuple[str, ...]:
    return name_of(pair.first.label), " and ", name_of(pair.second.label)


def _percent(pair: Pair) -> Html:
    return Html(f"{100 * pair.share:.0f}&nbsp;%")


def _side_by_side(found: Similar) -> Html:
    pairs = joined(_pair(number, pair) for number, pair in enumerate(found.pairs, 1))
    about = (
        "A number in the margin stands beside the first line of a passage and leads to the same one opposite."
        " What is open is printed."
    )
    return Html(tag("h2", "Side by side", class_="on-screen") + tag("p", about, class_="on-screen") + pairs)


def _pair(number: int, pair: Pair) -> Html:
    title = tag("h3", *_names(pair), ": ", _percent(pair), f", {pair.exercise}")
    blocks = _blocks(pair.passages)
    marked = [{line for passage in pair.passages for line in _lines(passage[side])} for side in (0, 1)]
    starts = [[block[side][0] for block in blocks] for side in (0, 1)]
    # Inside what opens, so that a browser opens it when it is asked to go there.
    sides = tag(
        "div",
        _side(pair.first, marked[0], starts[0], f"p{number}-a", f"p{number}-b"),
        _side(pair.second, marked[1], starts[1], f"p{number}-b", f"p{number}-a"),
        class_="sides",
        id=f"pair-{number}",
    )
    return tag("details", tag("summary", title), sides, class_="pair")


def _lines(passage: Passage) -> range:
    return range(passage[0], passage[1] + 1)


def _blocks(passages: Iterable[tuple[Passage, Passage]]) -> list[tuple[Passage, Passage]]:
    """Passages that follow each other on both sides, as one: what a reader takes for one."""
    found: list[tuple[Passage, Passage]] = []
    for first, second in sorted(passages):
        for at, (one, other) in enumerate(found):
            if _continues(one, first) and _continues(other, second):
                found[at] = (one[0], max(one[1], first[1])), (other[0], max(other[1], second[1]))
                break
        else:
            found.append((first, second))
    return found


def _continues(before: Passage, after: Passage) -> bool:
    """Whether one begins within the other, or with no more than blank lines between."""
    return before[0] <= after[0] <= before[1] + _BLANK + 1


def _side(document: Document, marked: set[int], starts: list[int], here: str, there: str) -> Html:
    """One source with what the other has too marked, and a way across at the start of each block."""
    begins: dict[int, list[int]] = {}
    for at, start in enumerate(starts, 1):
        begins.setdefault(start, []).append(at)
    lines = []
    for number, line in enumerate(document.source.splitlines(), 1):
        across = joined(
            tag("a", str(at), id=f"{here}-{at}", href=f"#{there}-{at}", aria_label=f"passage {at}, opposite")
            for at in begins.get(number, ())
        )
        alike = number in marked and bool(line.strip())
        shown = text(line.expandtabs(4))
        lines.append(tag("span", tag("b", f"{number:4} ", across), shown, class_="alike" if alike else None))
    heading = tag("h4", name_of(document.label))
    return tag("div", heading, tag("pre", joined(lines)))
