"""One student's state: the workspace folder, and what was done in it."""
