"""The full-screen reader of ``course lesson``.

app         opening and leaving it, keys and the mouse, the way through lessons, contents and search
items       what keys act on, and what they do: links, predictions, answers, cells, tasks, figures
page        the one widget: a lesson in progress, shown page by page, with the words around it
printing    a lesson's blocks as rows of a given width; a student's progress below a task
running     what goes on beside the page: cells run, tasks are checked, figures are drawn
asking      boxes over the page: a prediction, contents, search, code to edit, the keys
"""
