"""The quiz: questions posed from a seed, attempts scored, missed questions asked again."""
