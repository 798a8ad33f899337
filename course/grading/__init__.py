"""A class graded: from a folder of submissions to a gradebook, and from there to exports and reports.

intake      who handed in which exercise, or why there is nothing to grade
running     a run over a class, a second one, and the grader processes of both
gradebook   the record of a run
results     what counts: rosters, times, lateness, overrides
exports     files for other programs, and pages for people
container   the same graders in Gradescope
similar     submissions that are alike, and the page that shows them
quiz        the quiz records of a submission, scored again
cluster     the same run on many machines (optional)
"""
