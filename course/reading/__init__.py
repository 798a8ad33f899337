"""A lesson in progress: the reader's place, the predictions, each cell with its output. No screen is in here.

parts       a lesson cut into what a reader meets: sections, predictions and what each keeps closed, cells
record      what the reader did in one lesson, and the place in it, whatever the size of the screen
cells       running cells in a separate process, at the best protection this machine has
"""
