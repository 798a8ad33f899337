"""One student's state: the workspace folder, and the record of work in it."""
