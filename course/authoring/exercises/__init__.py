"""What the course proves of an exercise: its files, and that solutions pass, stubs fail and each wrong
variant loses exactly what it breaks.
"""
