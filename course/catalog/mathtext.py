"""Formulae for readers without a typesetter: Unicode text for a terminal, words for a screen reader.

Both forms keep what typesetting says by position: a numerator that is a sum gets brackets, a norm keeps its
bars, an exponent with no raised form in Unicode is written with ^.

Formulae are the part of LaTeX that lessons use, and not one command more. What is not in the tables below
raises MathError, so no reader gets a formula that was only half understood. Its author rewrites it or gives
the words by hand.
"""

import re
from dataclasses import dataclass
from textwrap import dedent
from typing import Protocol

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


class MathError(ValueError):
    """A formula uses something that has no agreed text form."""


def math_text(tex: str) -> str:
    """A formula as Unicode text; several lines, aligned, where the source has an ``aligned`` environment."""
    return dedent("\n".join(line.rstrip() for line in read_math(tex).shown().split("\n")))


def math_spoken(tex: str) -> str:
    """A formula in words, unambiguous when heard; several lines where the source has ``aligned``."""
    lines = []
    for line in read_math(tex).said().splitlines():
        words = line.replace(" ,", ",").replace(" ;", ";").replace(" .", ".")
        lines.append(" ".join(words.split()))
    return "\n".join(lines)


# ---
# The parts of a formula: each knows its text for the screen and its words for the ear.


class Node(Protocol):
    def shown(self) -> str: ...

    def said(self) -> str: ...


@dataclass(frozen=True, slots=True)
class Atom:
    """One symbol.

    Attributes:
        kind: "letter", "number", "words", "function", "binary", "relation", "punctuation" or "space".
        words: empty if it is not spoken.
    """

    kind: str
    text: str
    words: str

    def shown(self) -> str:
        return self.text

    def said(self) -> str:
        return self.words


@dataclass(frozen=True, slots=True)
class Row:
    items: tuple[Node, ...]

    def shown(self) -> str:
        out = ""
        for index, item in enumerate(self.items):
            before = _beside(self.items[:index][::-1])
            after = _beside(self.items[index + 1 :])
            piece = item.shown()
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
        # A relation brings its own spaces; beside a \, or a wide \quad they would double.
        return re.sub(" {4,}", "   ", out).replace("  =", " =").replace("=  ", "= ")

    def said(self) -> str:
        words = []
        for index, item in enumerate(self.items):
            before = _beside(self.items[:index][::-1])
            if isinstance(item, Atom) and item.text == "−" and not _is_operand(before):
                words.append("minus" if before is None else "negative")
            elif isinstance(item, Root) and is_factor(before):
                words.append(f"times {item.said()}")
            elif isinstance(item, Fraction) and is_factor(_beside(self.items[index + 1 :])):
                words.append(item.said_to_its_end())
            else:
                words.append(item.said())
        return " ".join(words)

    @property
    def is_single(self) -> bool:
        """Whether it needs no brackets anywhere: one symbol, with or without an index, or one bracket."""
        if len(self.items) != 1:
            return False
        only = self.items[0]
        return only.is_single if isinstance(only, Row) else not isinstance(only, Fraction | Grid)

    @property
    def is_sum(self) -> bool:
        return any(
            isinstance(item, Fraction)
            or (isinstance(item, Atom) and item.kind in ("binary", "relation") and item.text != "·")
            for item in self.items
        )


@dataclass(frozen=True, slots=True)
class Fraction:
    over: Row
    under: Row

    def shown(self) -> str:
        top, bottom = self.over.shown(), self.under.shown()
        if (top, bottom) in _VULGAR:
            return _VULGAR[top, bottom]
        if self.over.is_sum:
            top = f"({top})"
        if not self.under.is_single:
            bottom = f"({bottom})"
        return f"{top}/{bottom}"

    def said(self) -> str:
        if self.over.is_single and self.under.is_single and not self._is_half:
            return f"{self.over.said()} over {self.under.said()}"
        return self.said_to_its_end()

    def said_to_its_end(self) -> str:
        """With its end, even if it is simple, for something follows it."""
        if self._is_half:
            return "one half"
        return f"the fraction {self.over.said()} over {self.under.said()} end fraction"

    @property
    def _is_half(self) -> bool:
        return (self.over.shown(), self.under.shown()) == ("1", "2")


@dataclass(frozen=True, slots=True)
class Root:
    body: Row

    def shown(self) -> str:
        return "√" + (self.body.shown() if self.body.is_single else f"({self.body.shown()})")

    def said(self) -> str:
        return f"the square root of {self.body.said()}" + ("" if self.body.is_single else " end root")


@dataclass(frozen=True, slots=True)
class Script:
    """A base with an index below, an exponent above, or both."""

    base: Node
    sub: Row | None
    sup: Row | None

    def shown(self) -> str:
        out = self.base.shown()
        if isinstance(self.base, Fraction) or (isinstance(self.base, Row) and not self.base.is_single):
            out = f"({out})"
        if self.sub is not None:
            out += _moved(self.sub.shown(), _LOWERED, "_")
        if self.sup is not None:
            out += _moved(self.sup.shown(), _RAISED, "^")
        return out

    def said(self) -> str:
        said = self.base.said()
        if self.sub is not None and said == "the sum of":
            return f"the sum over {self.sub.said()} of"
        if self.sub is not None:
            said += f" sub {self.sub.said()}" + ("" if len(self.sub.items) == 1 else " end sub")
        if self.sup is None:
            return said
        power = self.sup.shown()
        if power in _POWERS:
            return f"{said} {_POWERS[power]}"
        return f"{said} to the power {self.sup.said()}" + ("" if len(self.sup.items) == 1 else " end power")


@dataclass(frozen=True, slots=True)
class Accent:
    name: str
    body: Row

    def shown(self) -> str:
        body = self.body.shown()
        if len(body) != 1:
            raise MathError(f"\\{self.name} over more than one letter has no text form")
        return body + ACCENTS[self.name]

    def said(self) -> str:
        return f"{self.body.said()} {_SPOKEN_ACCENTS[self.name]}"


@dataclass(frozen=True, slots=True)
class Fence:
    """Something between a pair of delimiters: ``()``, ``[]``, ``{}``, ``||`` or ``‖‖``."""

    left: str
    right: str
    body: Row

    def shown(self) -> str:
        return self.left + self.body.shown() + self.right

    def said(self) -> str:
        opening, closing = _SPOKEN_FENCES[self.left]
        return f"{opening} {self.body.said()} {closing}"


@dataclass(frozen=True, slots=True)
class Grid:
    """Lines of an ``aligned`` environment; the cells of a line are what ``&`` separates."""

    lines: tuple[tuple[Row, ...], ...]

    def shown(self) -> str:
        cells = [[cell.shown() for cell in line] for line in self.lines]
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

    def said(self) -> str:
        return "\n".join(" ".join(cell.said() for cell in line) for line in self.lines)


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


def _moved(text: str, table: dict[str, str], mark: str) -> str:
    """A script in raised or lowered characters where all of them exist, else after its mark."""
    tight = text.replace(" ", "")
    if all(char in table for char in tight):
        return "".join(table[char] for char in tight)
    return mark + (text if text.isalnum() else f"({text})")


def _is_operand(node: Node | None) -> bool:
    """Whether a sign after this node stands between two things, and is not a sign of what follows."""
    return node is not None and not (
        isinstance(node, Atom) and node.kind in ("binary", "relation", "punctuation", "space", "function")
    )


_GREEK = {
    "alpha": "α", "beta": "β", "gamma": "γ", "delta": "δ", "epsilon": "ε", "varepsilon": "ε", "zeta": "ζ",
    "eta": "η", "theta": "θ", "kappa": "κ", "lambda": "λ", "mu": "μ", "nu": "ν", "xi": "ξ", "pi": "π",
    "rho": "ρ", "sigma": "σ", "tau": "τ", "phi": "φ", "varphi": "φ", "chi": "χ", "psi": "ψ", "omega": "ω",
    "Gamma": "Γ", "Delta": "Δ", "Theta": "Θ", "Lambda": "Λ", "Sigma": "Σ", "Phi": "Φ", "Psi": "Ψ",
    "Omega": "Ω",
}  # fmt: skip

_SYMBOLS = {
    "cdot": Atom("binary", "·", "times"),
    "times": Atom("binary", "×", "times"),
    "pm": Atom("binary", "±", "plus or minus"),
    "approx": Atom("relation", "≈", "is about"),
    **dict.fromkeys(("le", "leq"), Atom("relation", "≤", "is at most")),
    **dict.fromkeys(("ge", "geq"), Atom("relation", "≥", "is at least")),
    "ne": Atom("relation", "≠", "is not"),
    "ll": Atom("relation", "≪", "is much less than"),
    "gg": Atom("relation", "≫", "is much greater than"),
    "propto": Atom("relation", "∝", "is proportional to"),
    "sim": Atom("relation", "~", "is of the order of"),
    "to": Atom("relation", "→", "goes to"),
    "in": Atom("relation", "∈", "is in"),
    "infty": Atom("letter", "∞", "infinity"),
    "partial": Atom("letter", "∂", "partial"),
    "prime": Atom("letter", "′", "prime"),
    "circ": Atom("letter", "°", "degrees"),
    "top": Atom("letter", "ᵀ", "transpose"),
    "%": Atom("letter", "%", "percent"),
    **dict.fromkeys(("ldots", "dots"), Atom("letter", "…", "and so on")),
    **dict.fromkeys((",", ";", " "), Atom("space", " ", "")),
    "quad": Atom("space", "   ", ""),
    "qquad": Atom("space", "      ", ""),
}
_FUNCTIONS = {
    "sin": "sine of", "cos": "cosine of", "tan": "tangent of", "arcsin": "arc sine of",
    "exp": "exponential of", "ln": "natural log of", "log": "log of",
    "max": "the maximum of", "min": "the minimum of", "det": "the determinant of", "sum": "the sum of",
}  # fmt: skip
_CHARACTERS = {
    "+": Atom("binary", "+", "plus"),
    "-": Atom("binary", "−", "minus"),
    "/": Atom("binary", "/", "over"),
    "=": Atom("relation", "=", "equals"),
    "<": Atom("relation", "<", "is less than"),
    ">": Atom("relation", ">", "is greater than"),
    ",": Atom("punctuation", ",", ","),
    ";": Atom("punctuation", ";", ";"),
    ":": Atom("punctuation", ":", ":"),
    ".": Atom("punctuation", ".", "."),
    "!": Atom("letter", "!", "factorial"),
    "'": Atom("letter", "′", "prime"),
}
ACCENTS = {"dot": "\u0307", "ddot": "\u0308", "hat": "\u0302", "bar": "\u0304", "vec": "\u20d7"}
#: What opens a bracket: what closes it, and both as they are shown.
_PAIRS = {
    "(": (")", "()"),
    "[": ("]", "[]"),
    r"\{": (r"\}", "{}"),
    r"\lvert": (r"\rvert", "||"),
    r"\lVert": (r"\rVert", "‖‖"),
    "|": ("|", "||"),
    r"\|": (r"\|", "‖‖"),
}
_TEXT_COMMANDS = {"text", "mathrm", "operatorname"}
_TOKEN = re.compile(r"\\[A-Za-z]+|\\.|\d+(?:\.\d+)?|\s+|.", re.DOTALL)


def read_math(tex: str) -> Node:
    """Read one formula."""
    row = _Reader(_tokens(tex.strip())).row(frozenset())
    return row.items[0] if len(row.items) == 1 else row


def _tokens(tex: str) -> list[str]:
    """White space counts inside the braces of ``\\text{…}`` and nowhere else."""
    tokens: list[str] = []
    in_words = False
    for token in _TOKEN.findall(tex):
        if token == "{" and tokens and tokens[-1].lstrip("\\") in _TEXT_COMMANDS:
            in_words = True
        elif token == "}":
            in_words = False
        if in_words or not token.isspace():
            tokens.append(token)
    return tokens


class _Reader:
    """Recursive descent over the tokens of one formula."""

    def __init__(self, tokens: list[str]) -> None:
        self._tokens = tokens
        self._at = 0

    def row(self, stops: frozenset[str]) -> Row:
        """Nodes up to, and not including, one of ``stops``."""
        items: list[Node] = []
        while (token := self._peek()) not in stops:
            if token is None and not stops:
                break
            if token is None:
                raise MathError(f"{' or '.join(sorted(stops))} is missing")
            if token in ("_", "^"):
                raise MathError(f"{token} has nothing before it")
            items.append(self._scripted(self._node()))
        _refuse_ambiguous_slash(items)
        return Row(tuple(items))

    def _peek(self) -> str | None:
        return self._tokens[self._at] if self._at < len(self._tokens) else None

    def _next(self) -> str:
        token = self._peek()
        if token is None:
            raise MathError("the formula ends too early")
        self._at += 1
        return token

    def _expect(self, wanted: str) -> None:
        found = self._next()
        if found != wanted:
            raise MathError(f"{wanted} was expected, {found} found")

    def _scripted(self, base: Node) -> Node:
        scripts: dict[str, Row] = {}
        while self._peek() in ("_", "^"):
            token, script = self._next(), self._argument()
            if token in scripts:
                raise MathError(f"two {token} on one symbol")
            scripts[token] = script
        return Script(base, scripts.get("_"), scripts.get("^")) if scripts else base

    def _argument(self) -> Row:
        if self._peek() == "{":
            self._next()
            body = self.row(frozenset("}"))
            self._expect("}")
            return body
        token = self._peek()
        if token is not None and token.isdigit() and len(token) > 1:
            # TeX takes one digit and leaves the rest behind: \frac12 and x^10 mislead their reader.
            raise MathError(f"{token} needs braces around what is meant")
        return Row((self._node(),))

    def _node(self) -> Node:
        if self._peek() == "{":
            return self._argument()
        token = self._next()
        if token == r"\left":
            return self._fence(self._next(), sized=True)
        if token in _PAIRS:
            return self._fence(token, sized=False)
        if token == r"\begin":
            return self._grid()
        if token.startswith("\\"):
            return self._command(token[1:])
        return _character(token)

    def _fence(self, left: str, *, sized: bool) -> Fence:
        if left not in _PAIRS:
            raise MathError(f"{left} does not open a bracket")
        right, shown = _PAIRS[left]
        body = self.row(frozenset({r"\right" if sized else right}))
        if sized:
            self._expect(r"\right")
        self._expect(right)
        return Fence(shown[0], shown[1], body)

    def _command(self, name: str) -> Node:  # noqa: PLR0911 - one return per kind of command
        if name in _GREEK:
            return Atom("letter", _GREEK[name], name.removeprefix("var"))
        if name in _SYMBOLS:
            return _SYMBOLS[name]
        if name in _FUNCTIONS:
            return Atom("function", "Σ" if name == "sum" else name, _FUNCTIONS[name])
        if name in ("frac", "tfrac", "dfrac"):
            return Fraction(self._argument(), self._argument())
        if name == "sqrt":
            return Root(self._argument())
        if name in ACCENTS:
            return Accent(name, self._argument())
        if name == "mathbf":
            return self._argument()
        if name in _TEXT_COMMANDS:
            words = self._words()
            return Atom("words", words, words)
        raise MathError(f"\\{name} has no agreed text form")

    def _words(self) -> str:
        self._expect("{")
        words = []
        while (token := self._next()) != "}":
            words.append(token)
        return "".join(words)

    def _grid(self) -> Grid:
        name = self._words()
        if name != "aligned":
            raise MathError(f"the environment {name} has no agreed text form")
        ends = frozenset({"&", "\\\\", r"\end"})
        lines: list[list[Row]] = [[]]
        token = ""
        while token != r"\end":
            lines[-1].append(self.row(ends))
            token = self._next()
            if token == "\\\\":
                lines.append([])
        if self._words() != name:
            raise MathError(f"\\end{{{name}}} is missing")
        return Grid(tuple(map(tuple, lines)))


def _refuse_ambiguous_slash(items: list[Node]) -> None:
    """``a/b c`` is read both ways by people; a fraction or brackets say which is meant."""
    visible = [item for item in items if not (isinstance(item, Atom) and item.kind == "space")]
    for index, item in enumerate(visible):
        if item == _CHARACTERS["/"]:
            factors = visible[index + 1 : index + 3]
            if len(factors) == 2 and all(is_factor(factor) for factor in factors):
                raise MathError("what stands under the slash is not clear; use \\frac or brackets")


def is_factor(node: Node | None) -> bool:
    """Whether a node beside another such node means multiplication."""
    return node is not None and not (
        isinstance(node, Atom) and node.kind in ("binary", "relation", "punctuation", "space", "words")
    )


def _character(token: str) -> Atom:
    if token[0].isdigit():
        return Atom("number", token, token)
    if token.isascii() and token.isalpha():
        return Atom("letter", token, token)
    if token in _CHARACTERS:
        return _CHARACTERS[token]
    raise MathError(f"{token} has no agreed text form")
