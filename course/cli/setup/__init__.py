"""What stands around the work: a first look, a workspace, this machine, and a report when something fails."""
