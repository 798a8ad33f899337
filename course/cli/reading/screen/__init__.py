"""The full-screen reader of ``course lesson``.

view        opening it, and what it leaves behind
app         keys, the mouse, and what they do: predict, follow, search
cells       a lesson on the screen whose cells run in place
showing     a lesson on the screen, to page through
telling     what is shown beside the lesson: keys, an exercise, contents, the place, what is next
page        the one widget: a head line, a screen of the lesson, a position bar, a line of keys
printing    a lesson's blocks as rows of a given width, with what can be acted on in them
drawing     figures as half blocks, drawn by a process of their own
running     cells that run while their reader reads on
machine     what the reader needs of the machine it runs on
asking      boxes over the page: contents, search, a prediction, a cell to edit
"""
