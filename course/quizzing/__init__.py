"""The quiz: questions posed from a seed, attempts scored, what was missed brought back."""
