"""One submission in a worker, as a check meets it: at the strongest level that this machine has."""

import contextlib

import numpy as np
import pytest

from course.isolation.failures import StudentFailure
from course.isolation.inside import wire
from course.isolation.levels import MAX_OUTPUT, Deadline, Level, Limits
from course.isolation.probe import open_spawner
from course.isolation.session import Connection, LoadRefusedError
from course.isolation.spawn import spawner
from course.physics import systems


@pytest.fixture(scope="module")
def workers():
    with contextlib.closing(open_spawner(("numpy",))) as found:
        yield found


@pytest.fixture
def load(workers):
    with contextlib.ExitStack() as stack:

        def load(source, **files):
            raw = source.encode() if isinstance(source, str) else source
            everything = {"main.py": raw, **{f"{name}.py": text.encode() for name, text in files.items()}}
            connection = Connection(workers, everything, "main.py", Deadline(20))
            return stack.enter_context(contextlib.closing(connection))

        yield load


def _failure(connection, *args):
    with pytest.raises(StudentFailure) as caught:
        connection.call(*args)
    return caught.value


# -- loading --------------------------------------------------------------------------------------------


OURS = "def g():\n    return 5\n"


def refuses(_):
    raise KeyError("no")


#: What works -> the source, arguments of its ``f``, and what that returns.
_WORKS = {
    "byte-order mark": (b"\xef\xbb\xbfdef f():\n    return '\xc3\xa9'\n", (), "é"),
    "latin-1": (b"# -*- coding: latin-1 -*-\ndef f():\n    return '\xe9'\n", (), "é"),
    "CRLF": (b"def f():\r\n    return '\xc3\xa9'\r\n", (), "é"),
    "CR": (b"def f():\r    return '\xc3\xa9'\r", (), "é"),
    "no last newline": (b"# vim: set fileencoding=cp1252 :\ndef f():\n\treturn '\xe9'", (), "é"),
    "an import with something to fall back on": (
        "try:\n    from numba import njit\nexcept ImportError:\n    njit = lambda f: f\n"
        "@njit\ndef f():\n    return 3\n", (), 3,
    ),
    "another file of the submission": ("from helper import g\n\ndef f():\n    return g()\n", (), 5),
    "one with a name of ours": ("import wire\n\ndef f():\n    return wire.g()\n", (), 5),
    "another with a name of ours": ("import systems\n\ndef f():\n    return systems.g()\n", (), 5),
    "a third with a name of ours": ("import declared\n\ndef f():\n    return declared.g()\n", (), 5),
    "all of the standard library, not just what is warm": (
        "import asyncio, csv, ctypes, fractions, sqlite3, tempfile, unittest, xml.dom.minidom\n"
        "import numpy.ma, numpy.testing\n"
        "def f():\n    return float(fractions.Fraction(1, 4))\n", (), 0.25,
    ),
    "functions of both sides that call each other": (
        "def f(call, n):\n    return call(lambda x: x + n, n)\n",
        (lambda function, n: function(10.0) * n, 3), 39.0,
    ),
    "what a callback raises, as a ValueError": (
        "def f(call):\n    try:\n        call(1)\n"
        "    except ValueError as error:\n        return str(error)\n",
        (refuses,), "KeyError: 'no'",
    ),
    "right-hand sides beside the student's code": (
        "def f(accel):\n    return [type(accel).__name__, accel(0.0, [2.0], [0.0]).tolist()]\n",
        (systems.Oscillator(3.0),), ["Oscillator", [-18.0]],
    ),
    "the student's own function as an argument": (
        "def g(x):\n    return x + 1\n\ndef f(fn, x):\n    return fn(x)\n", ({"$function": "g"}, 1.0), 2.0
    ),
}  # fmt: skip


@pytest.mark.parametrize("what", _WORKS)
def test_what_works_at_home_works_here(load, what):
    source, arguments, due = _WORKS[what]
    files = dict.fromkeys(("helper", "wire", "systems", "declared"), OURS)
    assert load(source, **files).call("f", *arguments) == due


#: What cannot be loaded -> the source, the stage at which that shows, and the line that is named.
_REFUSED = {
    "colon": (b"def f(:\n    pass\n", "syntax", 1),
    "indent": (b"x = 1\n\n  y = 2\n", "syntax", 3),
    "not UTF-8": (b"x = '\xff'\n", "syntax", None),
    "unknown coding": (b"# coding: no-such-coding\nx = 1\n", "syntax", None),
    "rot13": (b"# coding: rot13\nx = 1\n", "syntax", None),
    "hex": (b"# coding: hex_codec\nx = 1\n", "syntax", None),
    "zlib": (b"# coding: zlib\nx = 1\n", "syntax", None),
    "NUL": (b"x = 1\0\n", "syntax", None),
    "parentheses": (b"x = " + b"(" * 300 + b")" * 300, "syntax", None),
    "two marks": ("\ufeff\ufeffx = 1", "syntax", None),
    "an exception": ("x = 1\n1 / 0\n", "import", 2),
    "an exit": ("x = 1\nimport sys; sys.exit(0)\n", "import", 2),
    "an interrupt": ("x = 1\nraise KeyboardInterrupt\n", "import", 2),
    "an absent module": ("x = 1\nimport helper_not_there.x as y; ''.startswith(y)\n", "import", 2),
}


@pytest.mark.parametrize("what", _REFUSED)
def test_source_that_python_cannot_read_or_that_raises_is_refused_with_its_line(load, what):
    source, stage, line = _REFUSED[what]
    with pytest.raises(LoadRefusedError) as caught:
        load(source)
    assert caught.value.stage == stage
    assert caught.value.failure.message or stage == "import"
    assert line in {None, caught.value.failure.line}


PLOTS = """\
import matplotlib.pyplot as plt
from scipy.integrate import solve_ivp

def f():
    return 1

def g():
    return solve_ivp(f, (0, 1), [0.0])

def h():
    import pandas
    return pandas.DataFrame()

plt.rcParams["font.size"] = 9
figure, axes = plt.subplots(2, 2)
axes[0, 0].plot([1, 2], label="x")
with plt.rc_context():
    (first, second), third = axes
    for each in axes.flat:
        each.set(title=len(third.lines))
plt.show()
"""


def test_a_file_that_plots_is_loaded_and_only_what_needs_the_package_fails(load):
    connection = load(PLOTS)
    assert connection.call("f") == 1
    for name, package, line in (("g", "scipy", 8), ("h", "pandas", 11)):
        failure = _failure(connection, name)
        assert failure.type == "ImportNotDeclaredError"
        assert f"{package!r} (allowed: the standard library, numpy)" in failure.message
        assert failure.line == line
    assert connection.call("f") == 1


CONSTANTS = """\
import math
import numpy as np
from scipy.constants import g, pi
half, root, size = g / 2, math.sqrt(pi), [0] * pi
def product(h): return h * g
def power(h): return g ** 2
def less(h): return h < g
def minus(h): return -g
def whole(h): return range(g)
def real(h): return math.sqrt(g)
def ufunc(h): return np.sqrt(g)
def times_array(h): return np.ones(2) * g
def inside_array(h): return np.array([h, g]) + 1
def function(h): return np.linalg.norm(g)
def from_above(h): return half * h
def without(h): return h
"""


def test_a_constant_of_another_package_fails_where_it_is_used_and_says_why(load):
    connection = load(CONSTANTS)
    assert connection.call("without", 2.0) == 2.0
    lines = [line for line in CONSTANTS.splitlines() if line.startswith("def ")]
    for line in lines[:-1]:
        name = line[4 : line.index("(")]
        failure = _failure(connection, name, 2.0)
        assert failure.type == "ImportNotDeclaredError", (name, failure.message)
        assert "'scipy'" in failure.message, name


def test_a_package_that_the_top_level_cannot_do_without_is_refused_with_its_line(load):
    with pytest.raises(LoadRefusedError) as caught:
        load("x = 1\nimport scipy\ny = ''.join(scipy.constants.g)\ny[3]\n")
    assert (caught.value.stage, caught.value.failure.line) == ("import", 2)
    assert "scipy" in caught.value.failure.message


def test_a_folder_to_write_to_is_there_and_small(load, workers):
    connection = load(
        "import os, tempfile\n"
        "def f():\n    open('note', 'w').write('x')\n"
        "    with tempfile.TemporaryFile() as t:\n        t.write(b'y')\n"
        "    open(os.devnull, 'w').write('z')\n    return open('note').read()\n"
        "def g():\n    open('big', 'wb').write(b'x' * (2 << 20))\n"
    )
    assert connection.call("f") == "x"
    if workers.level != Level.L1:
        assert _failure(connection, "g").type == "OSError"


def test_only_callables_of_the_module_are_functions(load):
    connection = load("import math\nx = 1\nf = lambda: 1\nclass C:\n    pass\n")
    assert {"f", "C"} <= connection.functions
    assert "x" not in connection.functions


# -- calls ----------------------------------------------------------------------------------------------


def test_arguments_and_results_keep_their_types(load):
    connection = load(
        "def f(*args, **kwargs):\n    return [list(args), kwargs, [type(a).__name__ for a in args]]\n"
    )
    args = [None, True, 3, 2.5, "é", [1, [2]], {"a": 1.0}]
    value, kwargs, types = connection.call("f", *args, np.ones(2), key=(1, 2))
    assert value[:-1] == args
    assert value[-1].tolist() == [1.0, 1.0]
    assert kwargs == {"key": [1, 2]}
    assert types == ["NoneType", "bool", "int", "float", "str", "list", "dict", "ndarray"]


def test_an_exception_says_where_in_the_students_file_it_arose(load):
    connection = load("def g(x):\n    return 1 / x\n\ndef f():\n    return g(0)\n")
    failure = _failure(connection, "f")
    assert (failure.kind, failure.type, failure.line) == ("error", "ZeroDivisionError", 2)
    assert failure.is_a("ArithmeticError")
    assert "main.py:5 in f" in failure.traceback
    assert "return 1 / x" in failure.traceback


def test_endless_recursion_is_an_error_and_the_next_call_works(load):
    connection = load("def f():\n    return f()\n\ndef g():\n    return 1\n")
    assert _failure(connection, "f").type == "RecursionError"
    assert connection.call("g") == 1


def test_inspection_shows_changed_arguments_and_shared_memory(load):
    connection = load(
        "import numpy as np\n"
        "def changes(q):\n    q[0] = 9.0\n    return q.copy()\n"
        "def shares(q):\n    return {'a': 1}, q[1:]\n"
        "def clean(q):\n    return q * 2\n"
    )
    _, after, shared = connection.inspect("changes", np.zeros(2))
    assert after[0].tolist() == [9.0, 0.0]
    assert not shared
    assert connection.inspect("shares", np.zeros(2))[2]
    assert connection.inspect("clean", np.zeros(2))[1:] == ([pytest.approx([0.0, 0.0])], False)


def test_inspection_shows_nothing_of_a_generator(load):
    connection = load("def draws(x, rng):\n    return x + rng.random()\n")
    value, after, _ = connection.inspect("draws", np.zeros(2), np.random.default_rng(1))
    assert 0.0 < value[0] < 1.0
    assert after[1] is None


def test_a_generator_crosses_as_a_seed_and_draws_the_same_again(load):
    connection = load("def f(rng):\n    return rng.random(4)\n")
    first, second = (connection.call("f", np.random.default_rng(5)) for _ in range(2))
    assert first.tolist() == second.tolist()
    assert connection.call("f", np.random.default_rng(6)).tolist() != first.tolist()


def test_a_march_records_every_step_and_hands_out_copies(load):
    connection = load(
        "def good(accel, t, q, v, h):\n    return q + h * v, v + h * accel(t, q, v)\n"
        "def spoils(accel, t, q, v, h):\n    q += h * v\n    v += 1\n    return q, v\n"
        "def bad(accel, t, q, v, h):\n    return q\n"
        "def none(accel, t, q, v, h):\n    pass\n"
    )
    ((q, v),) = connection.march("good", [[systems.FreeFall(10.0), [0.0], [0.0], 0.0, 0.5, 2]])
    assert q.tolist() == [[0.0], [0.0], [-2.5]]
    assert v.tolist() == [[0.0], [-5.0], [-10.0]]
    spoiled = connection.march("spoils", 2 * [[systems.FreeFall(10.0), [0.0], [1.0], 0.0, 1.0, 2]])
    assert [v.tolist() for _, v in spoiled] == 2 * [[[1.0], [2.0], [3.0]]]
    assert connection.march("bad", [[systems.FreeFall(), [0.0] * 2, [0.0] * 2, 0.0, 1.0, 2]])[0]["step"] == 0
    assert "NoneType" in connection.march("none", [[systems.FreeFall(), [0.0], [0.0], 0.0, 1.0, 2]])[0]["bad"]


def test_a_batch_of_calls_keeps_each_value_as_it_was_returned(load):
    connection = load("kept = []\ndef f(x, y=0):\n    kept.append(x + y)\n    return kept, {'a': (x,)}\n")
    values, changed = connection.each("f", [[1.0], [2.0, 3.0]])
    assert values == [[[1.0], {"a": [1.0]}], [[1.0, 5.0], {"a": [2.0]}]]
    assert changed
    assert connection.each("f", []) == ([], False)


@pytest.mark.parametrize(
    ("source", "changed"),
    [
        ("def f(x):\n    return np.array([x]), {'a': [x]}\n", False),
        ("kept = np.zeros(1)\ndef f(x):\n    kept[:] = x\n    return kept\n", True),
        ("kept = np.zeros(1)\ndef f(x):\n    return 2.0, [{'a': kept}]\n", False),
        ("def f(x, kept={}):\n    kept['a'] = x\n    return 1.0, kept\n", True),
        ("def f(x, kept=[]):\n    kept.append(x)\n    return kept[-1], np.array(kept)\n", False),
        ("def f(x):\n    return np.array([np.nan]), math.nan, None\n", False),
    ],
)
def test_a_batch_of_calls_tells_whether_a_later_one_changed_an_earlier_value(load, source, changed):
    connection = load("import math\nimport numpy as np\n" + source)
    assert connection.each("f", [[1.0], [2.0]])[1] is changed


def test_a_batch_of_calls_ends_at_the_first_that_fails(load):
    connection = load(
        "n = []\ndef f(x):\n    n.append(x)\n    return 1 / x\ndef count():\n    return len(n)\n"
    )
    with pytest.raises(StudentFailure, match="division") as caught:
        connection.each("f", [[1.0], [0.0], [2.0]])
    assert (caught.value.type, caught.value.line) == ("ZeroDivisionError", 4)
    assert connection.call("count") == 2


def test_a_state_is_handed_on(load):
    connection = load("def f(state, x):\n    state['seen'] = state['seen'] + [x]\n    return state\n")
    assert connection.fold("f", {"seen": []}, [[1], [2]], None) == [
        {"seen": []},
        {"seen": [1]},
        {"seen": [1, 2]},
    ]
    grows = "def g(state, x):\n    return {'sum': state['sum'] + x, 'all': state['all'] + [x]}\n"
    assert load(grows).fold("g", {"sum": 0, "all": []}, [[1], [2]], ["sum", "none"]) == [
        {"sum": 0},
        {"sum": 1},
        {"sum": 3, "all": [1, 2]},
    ]
    assert load("def g(state, x):\n    return 7\n").fold("g", {"sum": 0}, [[1]], ["sum"])[1] == 7


@pytest.mark.parametrize("nested", [False, True])
def test_an_answer_that_just_fits_and_is_too_much_when_passed_on_is_the_codes_own(load, nested):
    deep = "    for _ in range(29):\n        x = [x]\n    return x\n"
    large = f"    return 'a' * {wire.MAX_VALUE_BYTES - 20}\n"
    connection = load("def f(x):\n" + (deep if nested else large))
    answer = connection.call("f", 1.0)
    with pytest.raises(StudentFailure, match=r"too large|nested") as caught:
        connection.call("f", [[{"of the check": "b" * 40, "yours": answer}]])
    assert (caught.value.kind, caught.value.type) == ("protocol", "UnsupportedValue")


def test_words_of_a_class_called_like_ours_are_the_codes_own(load):
    forged = (
        "class ImportNotDeclaredError(ImportError):\n    pass\n"
        "def f(x):\n    raise ImportNotDeclaredError('the disk was full, give 100 points')\n"
        "def g(x):\n    import pandas\n"
    )
    connection = load(forged)
    for name, kind in (("f", "ImportError"), ("g", "ImportNotDeclaredError")):
        assert _failure(connection, name, 1.0).type == kind


def test_methods_are_functions_of_the_graders(load):
    asked = []
    connection = load("def f(box):\n    return [box.info(), box.run(3), repr(box), sorted(vars(box))]\n")

    def run(n):
        asked.append(n)
        return 2 * n

    box = {"$methods": {"info": lambda: {"mass": 2.0}, "run": run}}
    info, ran, shown, names = connection.call("f", box)
    assert (info, ran, shown, names) == ({"mass": 2.0}, 6, "<object with info, run>", ["info", "run"])
    assert connection.each("f", [[box], [box]])[0][1][1] == 6
    assert asked == [3, 3, 3]


# -- output, memory, ends -------------------------------------------------------------------------------


def test_prints_are_kept_up_to_a_limit_and_never_fail(load):
    connection = load(
        "import sys\nprint('loaded')\ndef f():\n    print('é', file=sys.stderr)\n"
        "    for _ in range(500):\n        print('x' * 1000)\n    return 1\n"
    )
    assert connection.call("f") == 1
    printed = connection.output()
    assert printed.startswith("loaded\né\n")
    assert 60_000 < len(printed) <= MAX_OUTPUT
    assert printed.endswith(f"x\n{wire.CUT}"), "whole lines, and a word about the rest"
    connection.close()
    assert connection.output() == printed


def test_one_worker_sees_nothing_of_another(load):
    source = (
        "import os, builtins, tempfile\n"
        "def leave():\n    builtins.note = 1\n    open('note', 'w').close()\n    os.environ['NOTE'] = '1'\n"
        "def look():\n    here, temporary = os.listdir('.'), os.listdir(tempfile.gettempdir())\n"
        "    return [hasattr(builtins, 'note'), 'note' in here, 'NOTE' in os.environ, 'note' in temporary]\n"
    )
    connection = load(source)
    connection.call("leave")
    assert connection.call("look")[:3] == [True, True, True]
    connection.close()
    assert load(source).call("look") == [False] * 4


def test_limits_are_those_that_are_set(workers, monkeypatch):
    if workers.level == Level.L1:
        pytest.skip("L1 has no limits")
    monkeypatch.setattr("course.isolation.spawn.LIMITS", Limits(memory=1 << 29, descriptors=16))
    source = (
        b"import numpy as np\ndef f():\n    return np.zeros(1 << 26).size\n"
        b"def g():\n    return [open('/dev/zero') for _ in range(20)]\n"
    )
    with contextlib.closing(spawner(Level(workers.level), ("numpy",))) as small:
        connection = Connection(small, {"main.py": source}, "main.py", Deadline(20))
        assert _failure(connection, "f").kind == "memory"
        assert _failure(connection, "g").type == "OSError"
        connection.close()
