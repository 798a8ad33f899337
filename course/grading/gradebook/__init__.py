"""The record of a grading run, as an SQLite file.

file      its format, its lock, its seal, and SQLite's errors as sentences
book      what is read from it and written to it
records   what it holds, as types
backup    its copies
pages     rows of a damaged file, read without SQLite
salvage   a new gradebook of all that is whole in a damaged one
"""
