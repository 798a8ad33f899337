"""The same grading run on many machines: Dask carries batches out and verdicts back.

messages     what crosses the wire: bytes, in a shape both sides check
worker       what a Dask worker does with a batch: a warm grader process of its own grades it
coordinator  who gets which batch, and what happens to the work of a lost worker; knows nothing of Dask
reach        whether a scheduler can be reached with the certificates there are
connect      Dask itself: a cluster here or somewhere else, as something ``grade_class`` can use
"""
