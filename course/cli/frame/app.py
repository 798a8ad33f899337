"""The program: take the global options, run one command, say how it ended.

This is the only place where an error becomes words and an exit code.
"""

import atexit
import contextlib
import errno
import gc
import io
import os
import platform
import signal
import sys
import tempfile
import traceback
from collections.abc import Callable, Sequence
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Any, NoReturn

import typer

from course import __version__
from course.cli.frame.console import Console, current, install
from course.cli.frame.options import Line, global_options, option
from course.cli.frame.registry import HOME, build, find, understood
from course.errors import (
    INTERRUPTED,
    CourseError,
    InternalError,
    MissingCapabilityError,
    NotFoundError,
    UsageError,
)

#: A disk without room, or a user's share of it.
_FULL = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG}
_MAKE_ROOM = "Make room, or write elsewhere."
#: What the file system refuses, and what its owner can do. Where a command knows more, it says so itself.
_REFUSED = {
    **dict.fromkeys(_FULL, _MAKE_ROOM),
    **dict.fromkeys((errno.EACCES, errno.EPERM), "Check its permissions and those of the folders above it."),
    errno.EROFS: "Work in a folder that can be written.",
    errno.ENAMETOOLONG: "Choose a shorter name.",
    errno.ELOOP: "A link there leads to itself: remove it.",
}
SHELLS = ("bash", "zsh", "fish", "powershell", "pwsh")


#: Loading a command makes tens of thousands of objects, none of them garbage. Python's default, to collect
#: after every 700, took a tenth of the time to a lesson's first page.
_GARBAGE = 50_000


def main() -> NoReturn:
    gc.set_threshold(_GARBAGE, 20, 20)
    atexit.register(gc.freeze)  # nor is it worth looking for when the process ends
    _end_as_after_ctrl_c()
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:  # closed, as `course >&-` does it
            setattr(sys, name, Path(os.devnull).open(mode, encoding="utf-8"))  # noqa: SIM115
    if "_COURSE_COMPLETE" in os.environ:
        _program(fancy=False).main(prog_name="course")
    sys.exit(run(sys.argv[1:]))


def _end_as_after_ctrl_c() -> None:
    """A closed window or a plain kill ends a command as Ctrl-C does, so that it cleans up behind itself."""

    def stop(_number: int, _frame: object) -> None:
        raise KeyboardInterrupt

    for name in ("SIGTERM", "SIGHUP", "SIGBREAK"):
        number = getattr(signal, name, None)
        if number is not None and signal.getsignal(number) is signal.SIG_DFL:  # not below nohup
            signal.signal(number, stop)


def run(arguments: Sequence[str]) -> int:
    """Run one command line and return its exit code; never raises."""
    line = global_options(arguments)
    console = install(Console(line.settings))
    try:
        line = replace(line, rest=understood(line.rest))
        if line.rest[:1] == ("--version",):
            line = replace(line, version=True)
        code = _dispatch(line, console)
        if code == INTERRUPTED and not console.emitted:
            raise KeyboardInterrupt
    except KeyboardInterrupt:
        code = _say(console, line, INTERRUPTED, "interrupted", "Interrupted.")
    except CourseError as error:
        code = _say(console, line, error.exit_code, error.code, error.message, error.help)
    except Exception as error:  # noqa: BLE001 - the boundary: nothing passes it
        if hasattr(error, "format_message"):
            code = _usage(console, line, error)
        elif isinstance(error, OSError) and error.errno in (_REFUSED if error.filename else _FULL):
            with contextlib.suppress(OSError):
                console.flush()  # if it is the output that has no room, nothing more goes there
            code = _refused(console, line, error)
        else:  # our fault: the details go to a file, one line to the screen
            kind = f"A fault in the course, not in your work ({type(error).__name__})"
            message = f"{kind}; the details are in {write_report(error)}."
            code = _say(console, line, InternalError.exit_code, "internal", message)
    if console.json and not console.emitted:  # one object, of a command that adds nothing to its exit code
        from course.cli.frame.replies import Bare, schema_of_line

        console.emit(Bare(schema=schema_of_line(line), ok=code == 0, exit_code=code))
    try:
        console.flush()
    except OSError as error:
        code = _refused(console, line, error)
    return code


def again(arguments: Sequence[str]) -> int:
    """Run a command within this run, with its console; raises what the command raises."""
    result = _program(fancy=current().fancy).main(list(arguments), prog_name="course", standalone_mode=False)
    return result if isinstance(result, int) else 0


def _dispatch(line: Line, console: Console) -> int:
    if line.problem:
        raise UsageError(line.problem, help="Try `course --help`.")
    if line.version:
        from course.cli.frame.replies import Version

        python = ".".join(map(str, sys.version_info[:3]))
        console.line(f"course {__version__} (Python {python})")
        console.emit(Version(version=__version__, python=python))
        return 0
    if (directory := line.settings.directory) is not None:
        try:
            os.chdir(directory)
        except OSError as error:
            problem = f"-C names {directory}, which cannot be entered ({error.strerror})."
            fix = "Name a folder that exists."
            raise NotFoundError(problem, help=fix, code="directory_not_found") from error
    if line.rest[:1] in {("--show-completion",), ("--install-completion",)} and len(line.rest) == 2:
        return _completion(console, *line.rest)
    if not console.json:
        return again(line.rest)
    # A library's own output must not end up beside the one object.
    stray = io.StringIO()
    with contextlib.redirect_stdout(stray):
        code = again(line.rest)
    if stray.getvalue() and not console.emitted and {"-h", "--help"} & set(line.rest):
        from course.cli.frame.replies import Help

        console.emit(Help(text=stray.getvalue()))
    elif stray.getvalue():
        console.raw(stray.getvalue())
    return code


def _program(*, fancy: bool) -> Any:
    app = build(fancy=fancy)
    app.callback(epilog="Start with: course demo, then course init my-course.")(_root)
    program = typer.main.get_command(app)
    for one in program.params:
        if one.name in {"install_completion", "show_completion"}:
            one.help = f"{one.help.rstrip('.')}; for another one, name it: zsh."  # type: ignore[attr-defined]
    return program


def _root(
    ctx: typer.Context,
    json: Annotated[bool, option("--json", "Print one JSON object.")] = False,
    plain: Annotated[bool, option("--plain", "No boxes, no colour, no motion; one fact a line.")] = False,
    quiet: Annotated[bool, option("--quiet -q", "Only the result.")] = False,
    directory: Annotated[str | None, option("-C DIR", "Work in this folder.")] = None,
    version: Annotated[bool, option("--version", "Print the version.")] = False,
) -> int | None:
    """Learn physics simulation for robotics: lessons, exercises and their checks.

    Without a command: where you are and what is next. Everything works offline.
    """
    # Taken out of the line before it is parsed; declared so that --help and completion know them.
    del json, plain, quiet, directory, version
    if ctx.invoked_subcommand is not None or ctx.resilient_parsing:
        return None
    home: Callable[[], int] = find(*HOME)
    return home()


def _completion(console: Console, option: str, shell: str) -> int:
    """For the named shell; typer's own options take no name, and find out which shell they run in."""
    from typer.completion import get_completion_script, install  # type: ignore[attr-defined]

    if shell not in SHELLS:
        problem = f"{option} {shell[:20]}: no such shell is known."
        raise UsageError(problem, help=f"Known: {', '.join(SHELLS)}.")
    if option == "--show-completion":
        variable = "_COURSE_COMPLETE"
        console.raw(get_completion_script(prog_name="course", complete_var=variable, shell=shell) + "\n")
        return 0
    _, path = install(shell=shell, prog_name="course", complete_var="_COURSE_COMPLETE")
    console.line(f"Completion for {shell} is in {path}; it works in a new shell.")
    return 0


def _say(console: Console, line: Line, exit_code: int, code: str, message: str, advice: str = "") -> int:
    """Report an error in place of a result."""
    console.error(message, advice)
    if console.json and (console.streams or not console.emitted):
        from course.cli.frame.replies import ErrorBody, ErrorReply, schema_of_line

        body = ErrorBody(code=code, message=message, help=advice)
        try:
            console.emit_line(ErrorReply(schema=schema_of_line(line), exit_code=exit_code, error=body))
        except OSError as full:  # a pipe that nobody reads is dealt with where the line began
            if full.errno not in _FULL:
                raise
            console.error(f"The output cannot be written ({full.strerror}).", _MAKE_ROOM)
            return MissingCapabilityError.exit_code
    return exit_code


def _refused(console: Console, line: Line, error: OSError) -> int:
    used = "written" if error.errno in _FULL or not error.filename else "used"
    message = f"{error.filename or 'The output'} cannot be {used} ({error.strerror or error})."
    kind, advice = MissingCapabilityError, _REFUSED.get(error.errno or 0, _MAKE_ROOM)
    return _say(console, line, kind.exit_code, kind.default_code, message, advice)


def _usage(console: Console, line: Line, error: Any) -> int:
    """A line that typer's parser refused. Known by its shape: the class moved between typer's versions."""
    context = getattr(error, "ctx", None)
    path = context.command_path if context is not None else "course"
    if type(error).__name__.startswith("NoArgsIsHelp"):
        if not console.json:
            console.error(str(error.format_message()))
        return _say(console, line, UsageError.exit_code, "usage", f"`{path}` needs a command.")
    message = str(error.format_message()).strip()
    for theirs, ours in (("a valid float", "a number"), ("a valid integer", "a whole number")):
        message = message.replace(f"is not {theirs}", f"is not {ours}")
    choices: list[str] = []
    if (missing := getattr(error, "param", None)) and type(error).__name__.startswith("MissingParameter"):
        # What could stand where an argument or an option is missing: what the shell would complete there.
        choices = [str(item.value) for item in missing.shell_complete(context, "")] if context else []
    known = f"Known: {', '.join(choices)}. " if 0 < len(choices) <= _MOST_CHOICES else ""
    return _say(console, line, UsageError.exit_code, "usage", message, f"{known}See `{path} --help`.")


_MOST_CHOICES = 20


# ---
# A report of a crash: everything needed to look for the fault, in a file, for the person to send or not.


#: Begins the line of a report that says which installation crashed: a user may have several.
INSTALLATION = "installation: "


def write_report(error: BaseException) -> str:
    """Write the report and return its path; if even that fails, a phrase that says so."""
    lines = [
        f"course {__version__}, Python {platform.python_version()}, {platform.platform()}",
        f"{INSTALLATION}{Path(__file__).resolve().parents[2]}",
        f"when: {datetime.now(UTC).isoformat(timespec='seconds')}",
        f"command: {sys.argv!r}",
        "",
        *traceback.format_exception(error),
    ]
    try:
        handle, path = tempfile.mkstemp(prefix="course-crash-", suffix=".txt")
        with os.fdopen(handle, "w", encoding="utf-8", errors="backslashreplace") as file:
            file.write("\n".join(lines))
    except OSError as problem:
        return f"no file, because none could be written ({problem.strerror or problem})"
    return path
