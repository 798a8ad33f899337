"""Which submissions are alike: compared on this machine, with the course's own code left out."""
