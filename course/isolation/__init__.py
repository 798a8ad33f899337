"""Where a student's code runs, at the best protection level this machine has, and what crosses the boundary.

levels                              the promises of each level, and the interface of every kind of worker
probe                               what this machine can enforce, found by trying
keeping                             sandboxes that one session takes over from another
spawn, forked, plain, launch, view  starting a worker; the part of the file system that it sees
session, deadline                   calls to a worker, each with its time limit
reports, failures                   what came back, read as untrusted data
inside                              what runs in the student's process
"""
