"""Formulae for readers without a typesetter: Unicode text for a terminal, words for a screen reader.

Both forms keep what typesetting says by position: a numerator that is a sum gets brackets, a norm keeps its
bars, an exponent with no raised form in Unicode is written with ^. A formula neither can render raises.
"""

from __future__ import annotations

from textwrap import dedent
from typing import assert_never

from course.catalog.mathtree import (
    ACCENTS,
    Accent,
    Atom,
    Fence,
    Fraction,
    Grid,
    MathError,
    Node,
    Root,
    Row,
    Script,
    is_factor,
    read_math,
)

_RAISED = dict(
    zip(
        "0123456789+−()=abcdefghijklmnoprstuvwxyzᵀ°′",
        "⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻⁽⁾⁼ᵃᵇᶜᵈᵉᶠᵍʰⁱʲᵏˡᵐⁿᵒᵖʳˢᵗᵘᵛʷˣʸᶻᵀ°′",
        strict=True,
    )
)
_LOWERED = dict(zip("0123456789+−()=aehijklmnoprstuvx", "₀₁₂₃₄₅₆₇₈₉₊₋₍₎₌ₐₑₕᵢⱼₖₗₘₙₒₚᵣₛₜᵤᵥₓ", strict=True))
_SMALL_LETTERS = frozenset(
    small for table in (_RAISED, _LOWERED) for big, small in table.items() if big.isalpha()
)
_VULGAR = {("1", "2"): "½", ("1", "3"): "⅓", ("2", "3"): "⅔", ("1", "4"): "¼", ("3", "4"): "¾",
           ("1", "6"): "⅙", ("1", "8"): "⅛"}  # fmt: skip
_POWERS = {"2": "squared", "3": "cubed", "ᵀ": "transpose", "°": "degrees", "′": "prime"}
_SPOKEN_ACCENTS = {"dot": "dot", "ddot": "double dot", "hat": "hat", "bar": "bar", "vec": "vector"}
_SPOKEN_FENCES = {
    "(": ("open bracket", "close bracket"),
    "[": ("open square bracket", "close square bracket"),
    "{": ("open brace", "close brace"),
    "|": ("the size of", "end size"),
    "‖": ("the norm of", "end norm"),
}


def math_text(tex: str) -> str:
    """A formula as Unicode text; several lines, aligned, where the source has an ``aligned`` environment.

    Raises:
        MathError: it uses something that has no agreed text form.
    """
    return dedent("\n".join(line.rstrip() for line in _text(read_math(tex)).split("\n")))


def math_spoken(tex: str) -> str:
    """A formula in words, unambiguous when heard; several lines where the source has ``aligned``.

    Raises:
        MathError: it uses something that has no agreed spoken form.
    """
    lines = []
    for line in _spoken(read_math(tex)).splitlines():
        words = line.replace(" ,", ",").replace(" ;", ";").replace(" .", ".")
        lines.append(" ".join(words.split()))
    return "\n".join(lines)


# ---------------------------------------------------------------- text


def _text(node: Node) -> str:  # noqa: PLR0911 - one return per kind of node
    match node:
        case Atom(text=text):
            return text
        case Row(items=items):
            return _row_text(items)
        case Fraction(over=over, under=under):
            return _fraction_text(over, under)
        case Root(body=body):
            return "√" + (_text(body) if _is_single(body) else f"({_text(body)})")
        case Script(base=base, sub=sub, sup=sup):
            return _script_text(base, sub, sup)
        case Accent(name=name, body=body):
            return _accented(name, _text(body))
        case Fence(left=left, right=right, body=body):
            return left + _text(body) + right
        case Grid(lines=lines):
            return _grid_text(lines)
        case _:
            assert_never(node)


def _row_text(items: tuple[Node, ...]) -> str:
    out = ""
    for index, item in enumerate(items):
        before = _beside(items[:index][::-1])
        after = _beside(items[index + 1 :])
        piece = _text(item)
        if isinstance(item, Fraction) and "/" in piece and (is_factor(before) or is_factor(after)):
            piece = f"({piece})"
        match item:
            case Atom(kind="relation"):
                piece = f" {piece} "
            case Atom(kind="binary", text="/" | "·"):
                pass
            case Atom(kind="binary") if _is_operand(before):
                piece = f" {piece} "
            case Atom(kind="punctuation") if after is not None:
                piece += " "
            case Atom(kind="words"):
                piece = _spaced(out, piece, after)
            case Atom(kind="function") | Script(base=Atom(kind="function")):
                piece = (" " if is_factor(before) and out[-1:] != " " else "") + piece
                piece += "" if isinstance(after, Fence) or after is None else " "
            case _ if is_factor(before) and _is_letter(out[-1:]) and _is_letter(piece[:1]):
                piece = f" {piece}"  # "g h t", which "ght" would hide
            case _:
                pass
        out += piece
    return _single_spaced(out)


def _beside(items: tuple[Node, ...]) -> Node | None:
    """The first of some nodes that is more than white space."""
    return next((item for item in items if not (isinstance(item, Atom) and item.kind == "space")), None)


def _spaced(out: str, words: str, after: Node | None) -> str:
    """Words in a formula, set off from what stands beside them."""
    lead = " " if out and not out.endswith(" ") and not words.startswith(" ") else ""
    trail = " " if after is not None and not words.endswith(" ") else ""
    return lead + words + trail


def _is_letter(char: str) -> bool:
    """Whether a character, with another such beside it, would look like a word."""
    return (char.isascii() and char.isalpha()) or char in _SMALL_LETTERS


def _single_spaced(text: str) -> str:
    # A relation brings its own spaces; beside a \, or a wide \quad they would double.
    while "    " in text:
        text = text.replace("    ", "   ")
    return text.replace("  =", " =").replace("=  ", "= ")


def _fraction_text(over: Row, under: Row) -> str:
    top, bottom = _text(over), _text(under)
    if (top, bottom) in _VULGAR:
        return _VULGAR[top, bottom]
    if _is_sum(over):
        top = f"({top})"
    if not _is_single(under):
        bottom = f"({bottom})"
    return f"{top}/{bottom}"


def _script_text(base: Node, sub: Row | None, sup: Row | None) -> str:
    out = _text(base)
    if isinstance(base, Row | Fraction) and not (isinstance(base, Row) and _is_single(base)):
        out = f"({out})"
    if sub is not None:
        out += _moved(_text(sub), _LOWERED, "_")
    if sup is not None:
        out += _moved(_text(sup), _RAISED, "^")
    return out


def _moved(text: str, table: dict[str, str], mark: str) -> str:
    """A script in raised or lowered characters where all of them exist, else after its mark."""
    tight = text.replace(" ", "")
    if all(char in table for char in tight):
        return "".join(table[char] for char in tight)
    return mark + (text if text.isalnum() else f"({text})")


def _accented(name: str, body: str) -> str:
    if len(body) != 1:
        raise MathError(f"\\{name} over more than one letter has no text form")
    return body + ACCENTS[name]


def _grid_text(lines: tuple[tuple[Row, ...], ...]) -> str:
    cells = [[_text(cell) for cell in line] for line in lines]
    columns = max(len(line) for line in cells)
    widths = [max((len(line[i]) for line in cells if i < len(line)), default=0) for i in range(columns)]
    out = []
    for line in cells:
        # As in LaTeX, columns are alternately flush right and flush left, so relations line up.
        padded = [
            cell.rjust(widths[i]) if i % 2 == 0 else cell.ljust(widths[i]) for i, cell in enumerate(line)
        ]
        out.append("".join(padded).rstrip())
    return "\n".join(out)


# ---------------------------------------------------------------- words


def _spoken(node: Node) -> str:  # noqa: PLR0911 - one return per kind of node
    match node:
        case Atom(spoken=spoken):
            return spoken
        case Row(items=items):
            return _row_spoken(items)
        case Fraction(over=over, under=under):
            return _fraction_spoken(over, under)
        case Root(body=body):
            closing = "" if _is_single(body) else " end root"
            return f"the square root of {_spoken(body)}{closing}"
        case Script(base=base, sub=sub, sup=sup):
            return _script_spoken(base, sub, sup)
        case Accent(name=name, body=body):
            return f"{_spoken(body)} {_SPOKEN_ACCENTS[name]}"
        case Fence(left=left, body=body):
            opening, closing = _SPOKEN_FENCES[left]
            return f"{opening} {_spoken(body)} {closing}"
        case Grid(lines=lines):
            return "\n".join(" ".join(_spoken(cell) for cell in line) for line in lines)
        case _:
            assert_never(node)


def _row_spoken(items: tuple[Node, ...]) -> str:
    words = []
    for index, item in enumerate(items):
        before = _beside(items[:index][::-1])
        if isinstance(item, Atom) and item.text == "−" and not _is_operand(before):
            words.append("minus" if before is None else "negative")
        elif isinstance(item, Root) and is_factor(before):
            words.append(f"times {_spoken(item)}")
        elif isinstance(item, Fraction) and is_factor(_beside(items[index + 1 :])):
            words.append(_fraction_spoken(item.over, item.under, bounded=True))
        else:
            words.append(_spoken(item))
    return " ".join(words)


def _fraction_spoken(over: Row, under: Row, *, bounded: bool = False) -> str:
    """A fraction; ``bounded`` says where it ends even if it is simple, for something follows it."""
    top, bottom = _text(over), _text(under)
    if (top, bottom) == ("1", "2"):
        return "one half"
    if _is_single(over) and _is_single(under) and not bounded:
        return f"{_spoken(over)} over {_spoken(under)}"
    return f"the fraction {_spoken(over)} over {_spoken(under)} end fraction"


def _script_spoken(base: Node, sub: Row | None, sup: Row | None) -> str:
    said = _spoken(base)
    if sub is not None and said == "the sum of":
        return f"the sum over {_spoken(sub)} of"
    if sub is not None:
        said += f" sub {_spoken(sub)}" + ("" if len(sub.items) == 1 else " end sub")
    if sup is None:
        return said
    power = _text(sup)
    if power in _POWERS:
        return f"{said} {_POWERS[power]}"
    return f"{said} to the power {_spoken(sup)}" + ("" if len(sup.items) == 1 else " end power")


# ---------------------------------------------------------------- shape


def _is_single(row: Row) -> bool:
    """Whether a row needs no brackets anywhere: one symbol, with or without an index, or one bracket."""
    if len(row.items) != 1:
        return False
    only = row.items[0]
    return not isinstance(only, Fraction | Grid) and not (isinstance(only, Row) and not _is_single(only))


def _is_sum(row: Row) -> bool:
    return any(
        isinstance(item, Atom) and item.kind in ("binary", "relation") and item.text != "·"
        for item in row.items
    ) or any(isinstance(item, Fraction) for item in row.items)


def _is_operand(node: Node | None) -> bool:
    """Whether a sign after this node stands between two things, and is not a sign of what follows."""
    return node is not None and not (
        isinstance(node, Atom) and node.kind in ("binary", "relation", "punctuation", "space", "function")
    )
