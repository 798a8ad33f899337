"""Where a student's code runs, at the best protection level this machine has, and what crosses the boundary.

levels                              what each level promises, and what every kind of worker must give
probe                               what this machine can enforce, found by trying
spawn, forked, plain, launch, view  starting a worker; what it sees of the file system
session, deadline                   calls to a worker, each with its time limit
reports, failures                   what came back, read as untrusted data
inside                              what runs in the student's process
"""
