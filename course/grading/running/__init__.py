"""Grading a class: submissions go to grader processes, verdicts to the gradebook; also regrading.

run        a whole run, from the class's folder to the gradebook, and its numbers
folder     the folder of a run: created, opened, previewed, its files written anew
snapshot   the graders of a run, frozen
batch      this machine's grader processes, and which of them gets which submission
grader     one of them
rerun      a gradebook's submissions, graded again
assign     files that an instructor assigns to students
"""
