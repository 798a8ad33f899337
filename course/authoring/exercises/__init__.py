"""The proofs of an exercise: its files are in order, solutions pass, stubs fail and each wrong
variant loses exactly what it breaks. Everything here raises ContentError where a file of the exercise is
missing, is not Python, raises, or lacks what it has to say.
"""
