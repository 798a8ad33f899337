"""A run over a class: submissions to grader processes, verdicts to the gradebook; and grading again."""
