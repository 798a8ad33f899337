"""Where a stranger's code runs, at the best protection this machine has, and what crosses the boundary.

levels                              what each level promises, and what every kind of worker must give
probe                               what this machine can enforce, found by trying
spawn, forked, plain, launch, view  starting a worker; what it sees of the file system
session, deadline                   a worker asked questions, each with its time
reports, failures                   what came back, every byte of which is read as a stranger's
inside                              what runs beside the stranger's code
"""
