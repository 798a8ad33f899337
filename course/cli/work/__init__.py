"""A student's work: a workspace, exercises in it, their checks and hints, and handing them in."""
