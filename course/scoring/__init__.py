"""One submission judged: checks collected once, run through the boundary, and made into a verdict.

graders    the files of a grader process, and the version that they make
checks     the checks, as pytest has them
kit        what checks are written with
remote     the ``submission`` that checks call
values     reading what a student's function returned, which may be anything
failures   how a check ends, in words, and what an exercise's report shows a student
judging    the session that grades, and the words of its verdict
explain    from a wrong value to a named mistake, one story for each task
verdict    what it comes to, as types and as a person reads it

This folder, with ``isolation`` and ``physics``, is what decides a score.
"""
