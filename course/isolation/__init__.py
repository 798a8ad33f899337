"""Where a stranger's code runs, at the best protection this machine has, and what crosses the boundary.

probe, levels                       what this machine can enforce, found by trying
spawn, forked, plain, launch, view  starting a worker; what it sees of the file system
session, wire, frames, encoding, decoding, reports
                                    questions and answers, every byte of which is read as a stranger's
worker, zygote, lockdown, declared, loops
                                    what runs beside the stranger's code: standard library and numpy only
"""
