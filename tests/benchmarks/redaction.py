"""How much of a hidden number reaches its student: programs that try to send it, and what of it arrives.

    python tests/benchmarks/redaction.py [--numbers N] [--level L2]

Each program is graded under N seeds, so that a hidden check hands it N different numbers. It says what it was
given by one means: the kind of an exception, a line, a text, a time... What a student may read of each
grading is put down as text; so many different texts are so many bits. What the student cannot see is printed
beside it: a channel that is closed there too was never tried.
"""

import argparse
import math
import sys
from pathlib import Path

import msgspec

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT)]

from course.catalog.load import Catalog  # noqa: E402
from course.catalog.locate import Content  # noqa: E402
from course.grading.exports.selection import checks_for_student, problem_for_student  # noqa: E402
from course.scoring.judging.session import GradingSession  # noqa: E402
from course.scoring.judging.submission import Submission, Terms  # noqa: E402
from course.scoring.verdict import Verdict, finite  # noqa: E402

ARENA = ROOT / "tests" / "attacks" / "arena"
WRONG = ROOT / "tests" / "attacks" / "wrong_arena.py"

_HEAD = """
import builtins, os, time
seen = None
def drawn(rng):
    global seen
    if seen is None:
        seen = int(rng.random() * 2**16)
    return seen
def at_line(n, text="raise ValueError"):
    code = compile(text, __file__, "exec")
    exec(code.replace(co_firstlineno=n, co_filename=__file__), {})
errors = sorted(n for n, c in vars(builtins).items() if isinstance(c, type) and issubclass(c, Exception))
"""

#: Name of the channel -> the body of ``draw(rng, n)``, which has the number as ``x``.
SENDERS = {
    "type of a built-in exception": "raise getattr(builtins, errors[x % len(errors)], ValueError)",
    "type of one's own": "raise type('E' + str(x), (Exception,), {})",
    "text of an exception": "raise ValueError(x)",
    "line of an exception": "at_line(1 + x)",
    "line of a warning's text": "import warnings; warnings.warn(str(x)); raise ValueError",
    "not implemented, or a module that is not allowed": "raise NotImplementedError if x % 2 else ImportError",
    "what is printed": "print(x); return x",
    "a value": "return [float(x)] * n",
    "a type": "return [None, 1, 'a', [], {}, (), 1.5, True, b'', 1j][x % 10]",
    "a shape": "import numpy; return numpy.zeros((1 + x % 50, 1 + x % 3))",
    "keys": "return {str(x): 1}",
    "a class that cannot cross": "return type('C' + str(x), (), {})()",
    "an exit code": "os._exit(x % 256)",
    "time": "time.sleep((x % 16) * 0.02); return None",
    "time of a right answer": "time.sleep((x % 16) * 0.02); return list(rng.random(n))",
    "depth of a traceback": "f = lambda k: f(k - 1) if k else 1 / 0; return f(x % 40)",
    "which of all ends": (
        "return [lambda: 1/0, lambda: time.sleep(60), lambda: bytearray(1 << 40), lambda: os._exit(1),"
        " lambda: object(), lambda: None, lambda: [0.5] * n, lambda: 'a', lambda: exit()][x % 9]()"
    ),
}


def program(body: str, padding: int = 1 << 16) -> bytes:
    """The wrong code with a ``draw`` that sends; a line there is for each number."""
    source = WRONG.read_text("utf-8") + _HEAD
    source += f"\ndef draw(rng, n):\n    x = drawn(rng)\n    {body}\n"
    return (source + "\n" * padding).encode()


def shown(verdict: Verdict) -> str:
    """Everything that is handed out of a verdict, as one text."""
    seen = (
        [msgspec.to_builtins(check) for check in checks_for_student(verdict)],
        msgspec.to_builtins(problem_for_student(verdict)),
        (verdict.state, verdict.score, verdict.passed, verdict.warnings),
    )
    # The public checks ask for the same whatever the seed; their times are the machine's.
    plain = finite(msgspec.to_builtins(seen))
    for check in plain[0]:
        if check["visibility"] == "public":
            check["duration_ms"] = 0.0
    return str(plain)


def known(verdict: Verdict, *, timed: bool) -> str:
    """What the instructor has of the one check that is tried."""
    check = next(check for check in verdict.checks if check.id == "draw_seeded")
    return str(msgspec.to_builtins(check if timed else msgspec.structs.replace(check, duration_ms=0.0)))


def trial(numbers: int, level: str | None = None) -> dict[str, tuple[set[str], set[str]]]:
    """Of each sender what arrived at the student, and what at the instructor, over so many numbers."""
    parts = ("exercises", "lessons", "quiz", "solutions", "graders")
    catalog = Catalog(Content(root=ARENA, **{part: ARENA / part for part in parts}))
    exercise = catalog.exercise("arena")
    found: dict[str, tuple[set[str], set[str]]] = {name: (set(), set()) for name in SENDERS}
    for seed in range(numbers):
        terms = Terms(level=level, timeout=1.0, seed=seed)
        with GradingSession(exercise, catalog, scope="full", terms=terms) as session:
            for name, (arrived, noted) in found.items():
                handed_in = Submission({exercise.module: program(SENDERS[name])})
                verdict = session.grade(handed_in, only=["draw_seeded"])
                assert verdict.state == "graded", verdict.error
                arrived.add(shown(verdict))
                noted.add(known(verdict, timed=name.startswith("time")))
    return found


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--numbers", type=int, default=32)
    parser.add_argument("--level", default=None)
    options = parser.parse_args()
    print(f"{'sent by':50} {'student':>8} {'instructor':>10}   bits of {math.log2(options.numbers):.0f}")
    for name, (arrived, noted) in trial(options.numbers, options.level).items():
        print(f"{name:50} {math.log2(len(arrived)):8.2f} {math.log2(len(noted)):10.2f}", flush=True)


if __name__ == "__main__":
    main()
