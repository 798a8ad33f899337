"""Commands around the work: the demo, a workspace, a check of this machine, a report of a fault."""
