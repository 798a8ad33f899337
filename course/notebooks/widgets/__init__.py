"""Live widgets in a cell: the sandbox, a prediction, the quiz. Only these modules import anywidget."""
