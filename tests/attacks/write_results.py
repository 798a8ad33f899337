"""Writes a gradebook, a result file and a package into every folder it knows."""

import os

for folder in ("@ROOT@", "@ROOT@/tests", "@SITE@", os.path.dirname("@SECRET@"), "/tmp", "/var/tmp", "/dev/shm", "/",
               "/course-worker", "/packages", "/usr/lib", os.path.dirname(os.__file__), os.path.dirname(np.__file__)):
    for name in ("course_attack_gradebook.sqlite", "course_attack.py", "course_attack.pth", "course_attack_results.json"):
        try:
            with open(os.path.join(folder, name), "w") as handle:
                handle.write('{"score": 100}')
        except OSError:
            pass
for path in (os.__file__, np.__file__):  # opened only: if this works, nothing must come of it
    try:
        os.close(os.open(path, os.O_WRONLY))
        print("FILE-CANARY" + "-7f3a: could write to", path)
    except OSError:
        pass
path = "@SECRET@"
for damage in (lambda: open(path, "a").close(), lambda: os.truncate(path, 0), lambda: os.chmod(path, 0o777),
               lambda: os.utime(path, (1, 1)), lambda: os.rename(path, path + "x"), lambda: os.unlink(path),
               lambda: os.link(path, "linked"), lambda: os.symlink(path, "linked2")):
    try:
        damage()
    except OSError:
        pass
