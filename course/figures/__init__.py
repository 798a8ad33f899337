"""The figures of the lessons: one style, one registry, one builder per figure.

Only this package imports matplotlib, and only when a figure is drawn.
"""
