"""The record of a grading run, as an SQLite file.

file      its format, its lock, its seal, and SQLite's errors as sentences
book      reading from it and writing to it
records   its content, as types
salvage   its copies, and a new gradebook from the intact rows of a damaged one
"""
