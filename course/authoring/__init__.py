"""The course checks itself: the proofs of ``course author check``, and the templates of new content."""
