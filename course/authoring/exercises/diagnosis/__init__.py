"""What students are told of wrong work, proven: hypotheses, their words, and who is told what."""
