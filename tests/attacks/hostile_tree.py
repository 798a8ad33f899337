"""Leaves a deep tree of folders nobody may list, to trip whoever cleans up."""

import os

home = os.getcwd()
try:
    for _ in range(300):
        os.mkdir("course_attack_d", 0o700)
        os.chdir("course_attack_d")
except OSError:
    pass
os.chdir(home)
try:
    os.mkdir("closed", 0o300)
    open("closed/file", "w").close()
    os.mkdir("closed/inner", 0o000)
except OSError:
    pass
