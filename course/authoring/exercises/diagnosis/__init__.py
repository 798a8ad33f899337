"""Proofs of the diagnoses: hypotheses, their words, and the diagnosis of each wrong program."""
