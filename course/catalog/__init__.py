"""The course's content: files in, frozen models out; a fault comes with its file, line and fix.

locate, load       where the content of the course lies; lessons, exercises and the syllabus as models
reading            TOML into types, and the line that a fault stands on
markdown, blocks   lessons as blocks; mathtext speaks and spells their formulas
questions          the quiz, and the formulas that compute its numbers
pack               archives of solutions
"""
