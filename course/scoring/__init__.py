"""One submission judged: checks collected once, run through the boundary, and made into a verdict.

session, remote      a proven sandbox kept warm, and the ``submission`` that checks call
checks               the checks, as pytest has them
kit                  what checks are written with
values               reading what a student's function returned, which may be anything
explain, explaining  from a wrong value to a named mistake, one story for each task
failures, outcomes   how a check ends, in words; ``places`` tells the lines of a file or a notebook
verdict, numbers     what it comes to, as types and as a person reads it
report, reporting    what an exercise shows a student about their own code
version              which graders these are

This folder, with ``isolation`` and ``physics``, is what decides a score.
"""
