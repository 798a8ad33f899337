"""The sandbox in a terminal: half blocks, a mouse or keys, and the accounts beside the picture."""
