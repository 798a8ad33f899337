"""Gradescope's container: the zip that an instructor uploads there, and what it does with a submission.

packing   the zip: the program, the graders as a snapshot, and Gradescope's two scripts
inside    run there for each submission
"""
