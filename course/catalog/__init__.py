"""The course's content: files in, frozen models out; a fault comes with its file, line and fix.

locate, load       where the content of the course lies; lessons, exercises and the syllabus as models
reading, rules     TOML into types, and what a type cannot say (LineMap knows where in the file)
markdown, blocks   lessons as blocks; mathtext and mathtree speak and spell their formulas
questions          the quiz; formulas computes the numbers in it
pack               archives of solutions
"""
