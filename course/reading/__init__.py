"""A lesson in progress: the reader's place, the predictions, each cell with its output. No screen is in here.

parts       a lesson cut into what a reader meets: sections, predictions and what each keeps closed, cells
pages       screens of a given height out of lines of any width, and a place in the text that outlives both
record      what the reader did in one lesson, as events in the student's record
textbook    the modules of the course that cells import, as one archive
cells       running cells in a separate process, at the best protection this machine has
finding     words in one lesson or in all of them
"""
