"""What is alive in a cell: the sandbox, a prediction, the quiz. Only these modules import anywidget."""
