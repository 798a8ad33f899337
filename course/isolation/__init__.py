"""Where a student's code runs, at the best protection level this machine has, and what crosses the boundary.

levels     the promises of each level, the interface of every kind of worker, and the time limit of a call
probe      what this machine can enforce, found by trying, and sandboxes that one session hands to another
spawn      starting a worker: forked in a sandbox, or plain
launch     its files, its command, the part of the file system that it sees, and cleaning up
session    calls to a worker
failures   what came back, read as untrusted data
inside     what runs in the student's process

What needs a level, a package or a program that is not here raises IsolationError, with the causes.
"""
