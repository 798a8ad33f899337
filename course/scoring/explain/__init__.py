"""From a wrong value to a named mistake.

If a task returns wrong values, its function is called with the questions of the exercise: a few fixed calls,
the same at home and in a grading run. The answers are compared with those of each known wrong program
(``story``). If one of these programs gives the same answers, it decides the diagnosis. If none does, the
probes of the single checks decide, and of several probes the one that the others do not contradict.
The words are data.
"""
