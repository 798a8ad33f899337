"""The same grading run on many machines: Dask carries batches out and verdicts back.

worker       what a Dask worker does with a batch, and what crosses the wire, in a shape both sides check
coordinator  who gets which batch, and what happens to the work of a lost worker; knows nothing of Dask
connect      Dask itself: a cluster here or somewhere else, and whether it can be reached
"""
