"""A run over a class: submissions to grader processes, verdicts to the gradebook; and grading again.

run        a class graded, from its folder to the gradebook
folder     the folder of a run: begun, opened, previewed, its files written anew
summary    what a run came to
batch      grader processes of this machine, and who gets which submission
grader     one of them
snapshot   the graders of a run, frozen
rerun      what is in a gradebook, graded again
assign     files that an instructor says are whose
"""
