"""The sandbox in a terminal: half blocks, a mouse or keys, and the energy account beside the picture."""
