"""The cells of the notebooks that the course generates, and a newer notebook merged with an older one."""
