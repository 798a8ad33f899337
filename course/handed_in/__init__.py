"""Turns a student's submission into a module that can be graded.

limits     what is taken, and how large it may be
notebook   code cells as plain Python, the module that they stand for, and how its lines are told as cells
attempts   the public checks on it at home, and what is kept of them in the record
"""
