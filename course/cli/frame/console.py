"""The only place that prints.

Three shapes of output, decided once per run:

- fancy: a terminal; wrapped to its width, coloured unless NO_COLOR says otherwise;
- plain: a pipe, a log, ``--plain`` or TERM=dumb; one fact a line, no boxes, no colour, no motion;
- json: one object on standard output, and every word meant for a person on standard error.

Rich is imported only for the first. Commands call ``current()`` and never ``print``.
"""

from __future__ import annotations

import contextlib
import errno
import io
import json
import os
import re
import shutil
import stat
import sys
import textwrap
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TextIO, cast

from course.errors import InternalError
from course.printable import steady, unheeded

if TYPE_CHECKING:
    import msgspec
    from rich.console import Console as RichConsole
    from rich.text import Text

    from course.figures.registry import Builder


# ---
# An output stream whose reader may go away.


#: What is said of a pipe whose reader is gone, by Windows, too.
_GONE = {errno.EPIPE, errno.ECONNRESET} | ({errno.EINVAL} if os.name == "nt" else set())


class Stream:
    """A text stream whose reader may go away: ``course lessons | head -1`` is not an error.

    Raises:
        OSError: it cannot be written for another reason: it goes to a file, and the disk is full or fails.
    """

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self._open = True

    def write(self, text: str) -> int:
        self._unless_gone(lambda: self._stream.write(text))
        return len(text)

    def write_bytes(self, data: bytes) -> None:
        """Write UTF-8 bytes as they are, whatever encoding the stream has."""
        binary = getattr(self._stream, "buffer", None)
        if binary is None:
            self.write(data.decode("utf-8"))
            return
        self.flush()
        self._unless_gone(lambda: binary.write(data))
        self._unless_gone(binary.flush)

    def flush(self) -> None:
        self._unless_gone(self._stream.flush)

    def _unless_gone(self, action: Callable[[], Any]) -> None:
        """Do something with the stream, unless its reader is gone."""
        if not self._open:
            return
        try:
            action()
        except OSError as error:
            self._open = False
            gone = error.errno in _GONE or (error.errno == errno.EIO and not self._is_file())
            # The interpreter flushes the real stream once more when it exits; give it somewhere to go.
            with contextlib.suppress(OSError, ValueError):
                null = os.open(os.devnull, os.O_WRONLY)
                os.dup2(null, self._stream.fileno())
                os.close(null)
            if not gone:
                raise

    def _is_file(self) -> bool:
        """Whether it goes to a file; where it went to a terminal that hung up, nobody can be told."""
        with contextlib.suppress(OSError, ValueError):
            return stat.S_ISREG(os.fstat(self._stream.fileno()).st_mode)
        return False

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


# ---
# Text on its way to a terminal: made harmless, wrapped between words, styled.


Piece = str | tuple[str, str]


#: A command that people copy: what stands between backticks or after a colon, or how something is installed.
_PASTED = re.compile(r"`[^`\n]+`|pip install '[^\n]+|(?<=: )(?:course|jupyter)(?: [\w./#'=-]+)+")


def filled(row: str, width: int, margin: str = "", hanging: int = 0) -> str:
    """One row as several, broken between words only, and never within a command: what is copied is whole."""
    wrapper = textwrap.TextWrapper(width, margin, margin + " " * hanging)
    wrapper.break_long_words = wrapper.break_on_hyphens = False
    return wrapper.fill(_PASTED.sub(lambda piece: piece[0].replace(" ", _GLUE), row)).replace(_GLUE, " ")


_GLUE = "\0"


def bare(piece: Piece) -> str:
    """A piece without its style."""
    return harmless(piece if isinstance(piece, str) else piece[0])


def rich_text(pieces: Sequence[Piece]) -> Text:
    from rich.text import Text

    text = Text()
    for piece in pieces:
        text.append(bare(piece), None if isinstance(piece, str) else piece[1])
    return text


def harmless(text: str) -> str:
    """Text without control codes or workflow commands: a student's own text is shown, never obeyed."""
    return unheeded(steady(text.replace("\r\n", "\n")))


#: Long lines of prose are hard to read however wide the window is.
MAX_WIDTH = 100
#: Columns below which a table folds its cells until they cannot be read.
_NARROW = 60
#: Work that takes less than this shows nothing while it runs. In s.
PATIENCE = 0.5

_GO_ON = " Enter goes on, q stops: "

#: Colour repeats what a word already says; it never says anything alone.
STATUS_STYLE = {
    "pass": "green",
    "skip": "yellow",
    "grader_error": "magenta",
    **dict.fromkeys(("fail", "error", "timeout", "memory", "crash", "ungradable"), "red"),
}


@dataclass(frozen=True, slots=True)
class Settings:
    """The global options, as they were given anywhere on the command line."""

    json: bool = False
    plain: bool = False
    quiet: bool = False
    directory: str | None = None


class Console:
    """Prints in the shape that this run asks for."""

    def __init__(
        self,
        settings: Settings | None = None,
        *,
        stdout: TextIO | None = None,
        stderr: TextIO | None = None,
        environ: dict[str, str] | None = None,
    ) -> None:
        self.settings = settings = settings or Settings()
        #: Only the result and errors are wanted.
        self.quiet = settings.quiet
        self.json = settings.json
        self._environ = dict(os.environ) if environ is None else environ
        for stream in (sys.stdout, sys.stderr):
            # A console that cannot show a character shows a question mark, not a traceback.
            if hasattr(stream, "reconfigure"):
                stream.reconfigure(errors="replace")
        self._out = Stream(stdout or sys.stdout)
        self._err = Stream(stderr or sys.stderr)
        self._human: Stream = self._err if self.json else self._out
        shapeless = self.json or settings.plain or self._environ.get("TERM") == "dumb"
        self.fancy = not shapeless and bool(self._environ.get("FORCE_COLOR") or self._human.isatty())
        #: There are no boxes, no colour and no motion.
        self.plain = not self.fancy
        self._rich: RichConsole | None = None
        self.emitted = False
        #: Several lines are the answer, and an error may still be the last.
        self.streams = False
        #: Set while ``course go`` runs a command.
        self.led = False

    @property
    def interactive(self) -> bool:
        """True if a user is there to answer a question."""
        return not self.json and sys.stdin is not None and sys.stdin.isatty()

    @property
    def converses(self) -> bool:
        """True if a user reads the words of the run on a terminal and can answer them there."""
        return self.interactive and not self.quiet and bool(self._human.isatty())

    @property
    def motion(self) -> bool:
        """True if something may move while there is work, on a terminal only."""
        return self.fancy and not self.quiet and bool(self._human.isatty())

    @property
    def draws(self) -> bool:
        """True if the output can show a picture made of half blocks: many colours, and the letter itself."""
        if not self.fancy or self.quiet:
            return False
        from course.cli.frame.pictures import has_half_blocks

        return has_half_blocks(self.rich())

    @property
    def wraps(self) -> bool:
        """True on a terminal without layout, where words wrap; --plain keeps each fact on one line."""
        return self.plain and not (self.settings.plain or self.json) and bool(self._human.isatty())

    @property
    def width(self) -> int:
        return self.rich().width if self.fancy else min(self.terminal_width, MAX_WIDTH)

    @property
    def terminal_width(self) -> int:
        return shutil.get_terminal_size().columns

    @property
    def height(self) -> int:
        return shutil.get_terminal_size().lines

    def rich(self) -> RichConsole:
        """The Rich console behind a fancy run; in the other shapes one without colour or markup."""
        if self._rich is None:
            from rich.console import Console as RichConsole

            self._rich = RichConsole(
                file=cast("TextIO", self._human),
                force_terminal=self.fancy,
                no_color=True if self.plain or self._environ.get("NO_COLOR") else None,
                markup=False,
                emoji=False,
                highlight=False,
            )
        # The window may change while a long command runs.
        self._rich.width = max(20, min(self.terminal_width, MAX_WIDTH))
        return self._rich

    # -- what a person reads -------------------------------------------------------------------------

    def line(self, *pieces: Piece, indent: int = 0) -> None:
        """One line of the answer: strings, or (string, style) pairs, joined as they are.

        Words wrap at the width of the window. An address or a path that is longer stays in one piece, so that
        it can be copied.
        """
        if not self.fancy:
            self._fact("".join(bare(piece) for piece in pieces), indent)
            return
        from rich.padding import Padding

        text = rich_text(pieces)
        if _PASTED.search(text.plain) and "\n" not in text.plain:
            start, width = 0, self.width - indent
            for row in filled(text.plain, width).split("\n"):
                start = text.plain.index(row, start)
                self.rich().print(rich_text((" " * indent,)) + text[start : start + len(row)], soft_wrap=True)
                start += len(row)
        elif max(map(len, text.plain.split()), default=0) > self.width - indent:
            self.rich().print(rich_text((" " * indent, *pieces)), soft_wrap=True)
        else:
            self.rich().print(Padding(text, (0, 0, 0, indent)) if indent else text)

    def _fact(self, text: str, indent: int = 0, hanging: int = 0) -> None:
        """A line of plain output; on a terminal it wraps between words, and nowhere else."""
        margin = " " * indent
        rows = text.split("\n") if self.wraps else []
        if not any(len(row) + indent > self.width for row in rows):
            self._human.write(f"{margin}{text}\n")
            return
        self._human.write("".join(f"{filled(row, self.width, margin, hanging)}\n" for row in rows))

    def blank(self) -> None:
        """An empty line; ``--quiet`` drops it."""
        if not self.quiet:
            self._human.write("\n")

    def gap(self) -> None:
        """An empty line, where the output has a layout."""
        if self.fancy:
            self.blank()

    def heading(self, text: str, aside: str = "") -> None:
        """A line that names what follows it."""
        pieces: list[Piece] = [(text, "bold")]
        if aside:
            pieces.append((f"  {aside}", "dim") if self.fancy else f": {aside}")
        self.line(*pieces)

    def item(self, label: str, *pieces: Piece, style: str = "", indent: int = 2, width: int = 0) -> None:
        """A short label and a text beside it; in a terminal the text wraps under itself."""
        label = harmless(label)
        if not self.fancy:
            self._fact(f"{label}: " + "".join(bare(p) for p in pieces), indent, hanging=2)
            return
        from rich.cells import cell_len
        from rich.padding import Padding
        from rich.table import Table
        from rich.text import Text

        if cell_len(label) > self.width // 2:  # beside it, words would break
            self.line((label, style), indent=indent)
            self.line(*pieces, indent=indent + 2)
            return
        grid = Table.grid(padding=(0, 2, 0, 0))
        grid.add_column(no_wrap=True, min_width=width or len(label))
        grid.add_column(overflow="fold")
        grid.add_row(Text(label, style=style), rich_text(pieces))
        self.rich().print(Padding(grid, (0, 0, 0, indent)))

    def table(self, headers: Sequence[str], rows: Sequence[Sequence[Piece]]) -> None:
        """Rows under headings; facts under a row's name in a narrow window, one line each in plain output."""
        if not self.fancy:
            for row in rows:
                self._fact("; ".join(_named(headers, row, ": ")), hanging=2)
            return
        if self.width < _NARROW:
            self._facts(headers, rows)
            return
        from rich import box
        from rich.table import Table

        table = Table(box=box.SIMPLE_HEAD, pad_edge=False, padding=(0, 1))
        for index, head in enumerate(headers):
            table.add_column(head, overflow="fold", no_wrap=index == 0)  # the first is an id that people copy
        for row in rows:
            table.add_row(*(rich_text((cell,)) for cell in row))
        self.rich().print(table)

    def table_or_facts(self, headers: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
        """The rows as a table or, where it is too wide for the window, each fact under its row's name."""
        width = sum(max(map(len, column)) + 3 for column in zip(headers, *rows, strict=True))
        if self.plain or width <= self.width:
            self.table(headers, rows)
        else:
            self._facts(headers, rows)

    def _facts(self, headers: Sequence[str], rows: Sequence[Sequence[Piece]]) -> None:
        for first, *rest in rows:
            self.line(first)
            self.line(", ".join(_named(headers[1:], rest, " ")), indent=2)

    def figure(self, make: Builder) -> None:
        """Draw a figure as well as this terminal can show it; nothing where it cannot.

        Args:
            make: draws it; called in the house style, and only if there is somewhere to show it.
        """
        if not self.fancy or self.quiet:
            return
        from course.cli.frame.pictures import picture

        shown = picture(self.rich(), self._environ, make, self.width)
        if shown is not None:
            self.rich().print(shown)

    def block(self, text: str, language: str = "", indent: int = 0) -> None:
        """Text shown exactly as it is: code, a diff, a traceback."""
        text = harmless(text)
        if not self.fancy:
            for row in text.splitlines():
                self._human.write(" " * indent + row + "\n")
            return
        from rich.padding import Padding
        from rich.text import Text

        from course.cli.frame.pictures import Code

        self.rich().print(Padding(Code(text, language) if language else Text(text), (0, 0, 0, indent)))

    def note(self, *pieces: Piece, indent: int = 0) -> None:
        """Advice and next steps; ``--quiet`` drops it."""
        if not self.quiet:
            self.line(*pieces, indent=indent)

    def next(self, step: str) -> None:
        """The command that comes next, unless ``course go`` leads on and names it."""
        if not self.led:
            self.note(f"Next: {step}")

    def warn(self, text: str) -> None:
        """A warning, which is not a failure; on standard error."""
        self._aside(f"Note: {text}")

    def error(self, message: str, help: str = "") -> None:  # noqa: A002
        """What went wrong, and below it what to do; on standard error."""
        self._out.flush()
        self._aside(message)
        if help:
            self._aside(help)
        self._err.flush()

    def _aside(self, text: str) -> None:
        """Words on standard error; on a terminal a line that is too long for it wraps between words."""
        rows = harmless(text).split("\n")
        if self._err.isatty() and not (self.settings.plain or self.settings.json):
            width = min(self.terminal_width, MAX_WIDTH)
            rows = [filled(row, width) if len(row) > width else row for row in rows]
        self._err.write("\n".join(rows) + "\n")

    def raw(self, text: str) -> None:
        """Text that already has its layout (a help page)."""
        self._human.write(text)

    # -- what a script reads ---------------------------------------------------------------------------

    def emit(self, body: msgspec.Struct) -> None:
        """Write the one object of a ``--json`` run; does nothing in the other shapes."""
        if not self.json:
            return
        if self.emitted:
            raise InternalError("A command tried to print a second JSON object.")
        self.emitted = True
        self._out.write_bytes(encode(body) + b"\n")

    def answer(self, reply: Any) -> int:
        """End a command with its ``Envelope``, whose exit code is the command's."""
        self.emit(reply)
        return int(reply.exit_code)

    def emit_line(self, body: msgspec.Struct) -> None:
        """Write one line of JSON Lines, for the two commands that answer with several."""
        self.emitted = self.streams = True
        self._out.write_bytes(encode(body) + b"\n")

    # -- asking and waiting ------------------------------------------------------------------------------

    def confirm(self, question: str) -> bool:
        """Ask a yes-or-no question. Without a user to answer it, the answer is no."""
        if not self.interactive:
            return False
        return (self.ask(f"{question} [y/N] ") or "").lower() in {"y", "yes"}

    def ask(self, question: str) -> str | None:
        """What the user types on one line, without surrounding space; None at the end of the input."""
        self._out.write(self._wrapped(question))
        self._out.flush()
        answer = sys.stdin.readline()
        if not answer:
            self._out.write("\n")  # nobody typed the line's end
            return None
        return answer.strip()

    def _wrapped(self, question: str) -> str:
        """A question in lines that break between words; what is typed stands beside the last one."""
        if len(question) < self.terminal_width or not self._out.isatty():
            return question
        return filled(question.rstrip(), max(20, self.terminal_width - 1)) + " "

    @property
    def fills_the_screen(self) -> bool:
        """Whether the reader can open here: a user is there, and non-ASCII letters are shown."""
        reads = self.fancy and self.interactive and not self.quiet
        if not (reads and sys.stdout and sys.stdout.isatty()):
            return False
        if os.environ.get("TERM", "") in {"", "dumb", "unknown"}:
            return False
        return (sys.stdout.encoding or "").lower().replace("-", "") == "utf8"

    def go_on(self, where: str) -> bool:
        """Wait for Enter; q, n, or the end of the input, means no. Anything else is asked about again."""
        question = f"{where}{_GO_ON}".lstrip()
        while True:
            answer = self.ask(question)
            if answer is None or answer.lower() in {"q", "quit", "n", "no"}:
                return False
            if answer.lower() in {"", "y", "yes"}:
                return True
            question = f"{answer[:20]!r} was not run: this is not the shell yet.{_GO_ON}"

    def pause(self, where: str) -> bool:
        """Wait for Enter on a terminal that a person reads; elsewhere there is nothing to wait for."""
        if not (self.motion and self.interactive):
            return True
        rows = self._wrapped(f"{where}{_GO_ON}").count("\n") + 1
        going = self.go_on(where)
        self._human.write("\x1b[A\x1b[2K" * rows)  # the question is answered: what follows takes its lines
        return going

    @contextlib.contextmanager
    def paged(self) -> Iterator[None]:
        """Stop after each screenful of the output inside, where a person reads it; q skips the rest."""
        if not (self.motion and self.interactive):
            yield
            return
        human, held, rich = self._human, io.StringIO(), self.rich()
        self._human, rich.file = Stream(held), held
        try:
            yield
        finally:
            self._human, rich.file = human, cast("TextIO", human)
        rows = held.getvalue().splitlines(keepends=True)
        height = max(3, self.height - 1)
        for start in range(0, len(rows), height):
            if start and not self.pause(f"{start} of {len(rows)} lines."):
                return
            human.write("".join(rows[start : start + height]))

    @contextlib.contextmanager
    def working(self, what: str) -> Iterator[None]:
        """Show that something runs, once it has taken half a second, on a terminal only."""
        if not self.motion:
            yield
            return
        status = self.rich().status(what, spinner="line")
        timer = threading.Timer(PATIENCE, status.start)
        timer.daemon = True
        timer.start()
        try:
            yield
        finally:
            timer.cancel()
            timer.join()
            status.stop()

    def flush(self) -> None:
        self._out.flush()
        self._err.flush()


def _named(headers: Sequence[str], row: Sequence[Piece], between: str) -> list[str]:
    """The cells of a row that hold something, each after its heading."""
    return [head + between + bare(cell) for head, cell in zip(headers, row, strict=True) if bare(cell)]


def encode(body: msgspec.Struct) -> bytes:
    """``body`` as one line of JSON in UTF-8; numbers that JSON has not are "nan", "inf" and "-inf".

    The bytes of a name that are no text are spelled out.
    """
    import msgspec

    from course.scoring.verdict import finite

    plain = finite(msgspec.to_builtins(body))
    try:
        return msgspec.json.encode(plain)
    except UnicodeEncodeError:
        text = json.dumps(plain, ensure_ascii=False)
        return re.sub("[\ud800-\udfff]", lambda half: rf"\\u{ord(half[0]):x}", text).encode("utf-8")


_installed: Console | None = None


def install(console: Console) -> Console:
    """Make ``console`` the one that ``current`` gives; one run of the program has one."""
    global _installed  # noqa: PLW0603 - one process, one terminal
    _installed = console
    return console


def current() -> Console:
    return _installed if _installed is not None else install(Console())


# ---
# Shows the progress of long work, and about how long the rest will take.


@contextlib.contextmanager
def meter(console: Console) -> Iterator[Callable[[int, int, str], None]]:
    """A function to call with steps done, steps in all, and what is being done now.

    A terminal shows a bar with an estimate once the work has taken half a second, and removes it at the end.
    Elsewhere, after the same patience, a line is written whenever the work turns to something new: the part
    of its name before a colon.
    """
    seen: set[str] = set()
    started = time.monotonic()

    def say(done: int, total: int, what: str) -> None:
        topic = what.partition(":")[0]
        if what and topic not in seen and time.monotonic() - started > PATIENCE:
            seen.add(topic)
            console.note(f"Working on {topic}: {done} of {total} steps done.")

    if console.plain or console.quiet:
        yield say
        return
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (BarColumn(bar_width=20), TextColumn("{task.completed}/{task.total}"), TimeRemainingColumn())
    progress = Progress(*columns, TextColumn("{task.description}"), console=console.rich(), transient=True)
    task = progress.add_task("", total=None)

    def step(done: int, total: int, what: str) -> None:
        progress.update(task, completed=done, total=total, description=what)
        if not progress.live.is_started and time.monotonic() - started > PATIENCE:
            progress.start()

    try:
        yield step
    finally:
        progress.stop()
