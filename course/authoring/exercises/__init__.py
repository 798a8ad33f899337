"""The proofs of an exercise: its files are in order, solutions pass, stubs fail and each wrong
variant loses exactly what it breaks.
"""
