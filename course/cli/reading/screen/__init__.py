"""The full-screen reader of ``course lesson``.

view        opening and closing it
app         keys, the mouse, and what they do: predict, follow, search
cells       a lesson on the screen whose cells run in place
showing     a lesson on the screen, to page through
telling     the words around the lesson: keys, contents, the place, the next step
page        the one widget: a head line, a screen of the lesson, a position bar, a line of keys
printing    a lesson's blocks as rows of a given width, with the items that keys act on
drawing     figures as half blocks, drawn by a separate process
running     cells that run while their reader reads on
machine     writing to the current folder
asking      boxes over the page: contents, search, a prediction, a cell to edit
"""
