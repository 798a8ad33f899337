"""What a file finds where its student wrote it, and not where it is checked; and Python's commonest errors.

A check runs apart from the student's files, screen, keyboard and network, in one process with one thread; of
all packages it has those that the exercise allows. A line that needs more raises there, and Python's words
for that explain nothing to somebody on whose machine it works.
"""

from __future__ import annotations

import difflib
import math
import re
import sys

import numpy as np

from course.isolation.failures import StudentFailure

#: The Python that runs checks here, as people call it.
PYTHON = f"Python {sys.version_info.major}.{sys.version_info.minor}"
NUMPY = f"NumPy {'.'.join(np.__version__.split('.')[:2])}"

_PACKAGE = re.compile(r"importing '([^']{1,100})'")
_RELATIVE = re.compile(r"^\s*from\s+\.+(\w*)")
#: Packages that are certainly no file of the student's.
_KNOWN = frozenset(
    {
        "IPython", "PIL", "cv2", "ipywidgets", "jax", "manim", "matplotlib", "mpl_toolkits", "mujoco",
        "networkx", "numba", "pandas", "plotly", "pygame", "pylab", "pymunk", "requests", "scipy", "seaborn",
        "skimage", "sklearn", "sympy", "tensorflow", "torch", "tqdm", "vpython",
    }
)  # fmt: skip

#: What is imported most; a name near one of these is misspelt, more likely than a file.
_USUAL = (
    "collections", "dataclasses", "functools", "itertools", "math", "numpy", "random", "statistics", "typing",
)  # fmt: skip

_TYPES = "Nobody types while a check runs. Ask in a file of your own that imports this one."
_FILES = (
    "A check runs apart from your files and from the network. Read data in a file of your own that imports "
    "this one."
)
#: What Python says -> what that means here; both are looked for, the line of code too if it is not empty.
_LACKS: tuple[tuple[str, str, str], ...] = (
    (
        r"TclError|no display|could not find terminal|named '_?(tkinter|turtle|curses)'|DISPLAY",
        "",
        "There is no screen where a check runs, so no window can open. Draw in a file of your own that "
        "imports this one.",
    ),
    (r"can't start new thread", "", "A check runs in one process with one thread: no other can start."),
    (r"cannot join thread before it is started", "", "It waits for a thread, and no thread can start."),
    (
        r"URLError|gaierror|PermissionError|socket|ConnectionError",
        r"socket|connect|url|http|asyncio",
        "There is no network where a check runs, and nothing that needs a socket, such as asyncio's loops.",
    ),
    (
        r"PermissionError|FileNotFoundError|BlockingIOError|OSError",
        r"\b(Pool|Process|ProcessPoolExecutor|multiprocessing|subprocess|Popen|system|fork|kill|run|check_\w+)\b",
        "No other program and no other process can start where a check runs.",
    ),
    (r"^EOFError|getpass", "", _TYPES),
    (r"unsupported locale", "", "The languages of your computer are not there where a check runs."),
    # From Python 3.13 on, getpass says so without naming a function.
    (r"getpwuid|getlogin|ioctl|No username set", "", "Nobody is logged in where a check runs."),
    (
        r"from '__main__'|'__main__' has no",
        "",
        "`__main__` is your file only when you run it yourself; here it is loaded by a check.",
    ),
    (r"name '(exit|quit)'|^SystemExit", "", "It would end the program, and a check goes on."),
    (r"'StandIn'", "", "It uses a package that is not there."),
    (r"named '(winsound|msvcrt|winreg|_winapi)'", "", "Only Python on Windows has that module."),
    (r"OSError|unable to open database file", "", _FILES),
)


def lacking(failure: StudentFailure, code: str = "", *, shown: bool = True) -> str:
    """A sentence on what is not there where a check runs; "" if the failure has another cause.

    Args:
        code: the line that failed.
        shown: the failure's words may be repeated.
    """
    if failure.type == "ImportNotDeclaredError" or "relative import" in failure.message:
        return absent(failure, code, shown=shown)
    said = f"{failure.type}: {failure.message} {' '.join(failure.bases)}"
    for raised, line, sentence in _LACKS:
        if re.search(raised, said) and (not line or re.search(line, code)):
            return sentence
    return gone(failure, shown=shown)


def numpys(name: str) -> str:
    """How to get one of NumPy's names, as a sentence; "" if it is none of its own."""
    mine = name in dir(np) and not name.startswith("_")
    return f"`{name}` is NumPy's: write `from numpy import {name}`." if mine else ""


def absent(failure: StudentFailure, code: str = "", *, shown: bool = True) -> str:
    """What to do where a module is not there that may be a file of the student's; "" where it is none."""
    found = (_PACKAGE.search(failure.message) if shown else None) or _RELATIVE.search(code)
    name = found[1].partition(".")[0] if found else ""
    if name in _KNOWN:
        return ""
    what = f"{name}.py" if name.isidentifier() else "it"
    meant = difflib.get_close_matches(name, _USUAL, 1, 0.8)
    slip = f"Is `{name}` a slip for `{meant[0]}`? " if meant else ""
    return (
        f"{slip}If {what} is a file of yours: it is not handed in and not graded. Copy what you use of it "
        "into the file of the exercise."
    )


_ATTRIBUTE = re.compile(
    r"module '([\w.]+)' has no attribute '(\w+)'|cannot import name '(\w+)' from '([\w.]+)'"
    r"|`(np)\.(\w+)` was removed"
)
#: Names that one NumPy has and another has not -> what all have.
_INSTEAD = {
    "trapz": "np.trapezoid",
    "trapezoid": "np.trapz",
    "in1d": "np.isin",
    "product": "np.prod",
    "cumulative_sum": "np.cumsum",
    "sometrue": "np.any",
    "alltrue": "np.all",
    "NINF": "-np.inf",
    "asfarray": "np.asarray",
    "row_stack": "np.vstack",
    "round_": "np.round",
    "float_": "np.float64",
    "vecdot": "np.einsum",
    **dict.fromkeys(("cumproduct", "cumulative_prod"), "np.cumprod"),
    **dict.fromkeys(("Inf", "Infinity", "infty", "PINF"), "np.inf"),
    **dict.fromkeys(("NaN", "NAN"), "np.nan"),
    **dict.fromkeys(("matvec", "vecmat"), "@"),
    **{name: name for name in ("float", "int", "bool", "complex", "object", "str")},
}


def instead(module: str, name: str) -> str:
    """What to write for a name that not every version has, as a sentence; "" where nothing is known."""
    return f" Use `{_INSTEAD[name]}`." if module == "numpy" and name in _INSTEAD else ""


def gone(failure: StudentFailure, *, shown: bool = True) -> str:
    """A sentence on a name that this Python, or its NumPy, has not; "" if it is about none.

    Args:
        shown: the failure's words may be repeated; else only names of the table above are.
    """
    found = _ATTRIBUTE.search(failure.message)
    if found is None:
        return ""
    name, module = found[2] or found[3] or found[6], found[1] or found[4] or "numpy"
    better = instead(module, name)
    if not (shown or better):
        return ""
    if module.partition(".")[0] == "numpy":
        return f"{NUMPY}, which this is checked with, has no `{'np' + module[5:]}.{name}`.{better}"
    if module.partition(".")[0] in sys.stdlib_module_names - {"__main__"}:
        return f"{PYTHON}, which this is checked with, has no `{module}.{name}`."
    return ""


#: How newer Python looks in the line that an older one cannot read -> the version that has it.
_NEWER: tuple[tuple[str, str, tuple[int, int]], ...] = (
    ("", r"^\s*(type|(async\s+)?def|class)\s+\w+\s*\[[^\]]*=", (3, 13)),
    ("", r"^\s*type\s+\w+(\[.*\])?\s*=", (3, 12)),
    ("", r"^\s*(async\s+)?(def|class)\s+\w+\s*\[", (3, 12)),
    (r"^f-string: ", "", (3, 12)),
    ("", r"\b[fF][rR]?(\"\"\"|'''|['\"]).*\{", (3, 12)),
    ("multiple exception types must be parenthesized", "", (3, 14)),
    ("", r"\b[tT]['\"]", (3, 14)),
    (r"except\*|expected ':'", r"^\s*except\s*\*", (3, 11)),
)


def newer(failure: StudentFailure, code: str = "") -> str:
    """That a newer Python reads the line, which this one cannot; "" where nothing speaks for it.

    Args:
        code: the line.
    """
    for said, look, version in _NEWER:
        if version > sys.version_info and re.search(said, failure.message) and re.search(look, code):
            since = ".".join(map(str, version))
            return f"Python {since} reads that, but it is checked with {PYTHON}: write it the older way."
    return ""


def unread(failure: StudentFailure, code: str = "") -> str:
    """What to do about a line that Python cannot read, as a sentence or two; "" where nothing fits."""
    if advice := newer(failure, code):
        return advice
    if re.search(r"^invalid (?:non-printable )?character", failure.message):
        return "It came with a text that was pasted: delete that character and type it yourself."
    if re.search(r"^invalid (?:decimal|imaginary|hexadecimal) literal", failure.message):
        return "A letter follows a number. Is a `*` missing between them?"
    return ""


# ---
# Python's commonest errors, each with its own cure.

_MODULES = {"np": "import numpy as np", "numpy": "import numpy", "plt": ""}
_MODULES |= {
    name: f"import {name}"
    for name in (
        "bisect", "cmath", "collections", "copy", "functools", "itertools", "math", "operator", "random",
        "statistics", "sys", "time",
    )
}  # fmt: skip
_VERBS = {"+": "add to numbers", "-": "subtract", "*": "multiply", "/": "divide", "**": "have powers"}
_AN_ARRAY = (
    "Go through the values one by one, with `zip` for two lists, or make arrays first: `np.asarray(...)`."
)
_ONE_LESS = (
    "A number is subtracted from a whole list. If you mean one less than its length, write `len(a) - 1`; "
    "to subtract it from every value, make an array first: `np.asarray(...)`."
)
#: What Python says -> what to do about it. "{0}" is what the first group found.
_CURES: dict[str, str] = {
    r"UnboundLocalError.*variable '(\w+)'": (
        "Give `{0}` a value before the loop, or the `if`, that changes it."
    ),
    r"NameError: name '(\w+)'": "Is `{0}` spelled like this everywhere, and set before this line is reached?",
    r"can't multiply sequence by non-int": "A list times a number does not multiply its values. " + _AN_ARRAY,
    r"TypeError.*'NoneType'": (
        "Something here is None: a function without a `return`, or a variable nobody has set."
    ),
    r"TypeError: '(?:float|int|list|tuple)' object is not callable": (
        "Brackets after a value call it. Is a `*` missing, or has a variable taken the name of a function?"
    ),
    r"TypeError: '(?:float|int)' object is not iterable": "It is one number, and a list is needed here.",
    r"TypeError: '(?:float|int)' object is not subscriptable": (
        "It is one number, and a number has no [index]."
    ),
    r"TypeError: list indices must be .* not float": (
        "An index is an int: divide with `//`, or use `int(...)`."
    ),
    r"TypeError: list indices must be .* not tuple": (
        "A list of lists is indexed twice: `a[i][j]`, not `a[i, j]`."
    ),
    r"IndexError: list index out of range": (
        "A list of n values has the indices 0 to n - 1. Which index is it here?"
    ),
    r"IndexError.*out of bounds": "An axis of n values has the indices 0 to n - 1. Which index is it here?",
    r"ZeroDivisionError": "What is divided by is zero here. Which value makes it so?",
    r"ValueError: (?:math domain error|expected a (?:non-?negative|positive) (?:input|number))": (
        "It is the root or the logarithm of a negative number, or an arc sine of more than 1: print it."
    ),
    r"TypeError: only (?:size-1|length-1|0-dimensional) arrays": (
        "An array came where one number is needed. `math` and `float()` take one at a time; numpy's "
        "functions take arrays. In a call, look at the order of the arguments too."
    ),
    r"ValueError: The truth value of an array": (
        "Compare single numbers, or say `.any()` or `.all()` of them."
    ),
    r"positional arguments? but \d+ (?:was|were) given": (
        "Keep the stub's arguments in the `def`, all of them."
    ),
    r"missing \d+ required positional": "Pass every argument that the `def` names.",
    r"'bitwise_xor'|for \^": "`^` is no power in Python: write `**`.",
    r"RecursionError": (
        "The function calls itself more often than Python allows. Does it stop? A loop has no such limit."
    ),
    r"ValueError: (?:too many|not enough) values to unpack": (
        "The names on the left must be as many as the values."
    ),
}


def cure(failure: StudentFailure) -> str:
    """What to do about one of Python's commonest errors, as a sentence or two; "" for any other."""
    said = f"{failure.type}: {failure.message}"
    if found := re.search(r"^NameError: name '(\w+)'", said):
        name = found[1]
        if _MODULES.get(name):
            return f"Add `{_MODULES[name]}` at the top of the file."
        if hasattr(math, name) and not name.startswith("_"):
            return f"`{name}` is in math: add `import math` at the top, and write `math.{name}`."
    if found := re.search(r"unsupported operand type\(s\) for (\S+?)(?::| or ).*'(?:list|tuple)'", said):
        operator = found[1].rstrip("=")
        several = f"Python's lists do not {_VERBS.get(operator, 'calculate')}. {_AN_ARRAY}"
        return _ONE_LESS if operator == "-" and said.endswith("'list' and 'int'") else several
    found = re.search(r"AttributeError: '(list|float|int)' object has no attribute '(\w+)'", said)
    if found and hasattr(np.ndarray, found[2]):
        what = "list" if found[1] == "list" else "number"
        return f"Only arrays have `{found[2]}`; this is a {what}. Make an array first: `np.asarray(...)`."
    for pattern, advice in _CURES.items():
        if found := re.search(pattern, said):
            return advice.format(*found.groups())
    return ""
