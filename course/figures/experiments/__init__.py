"""The figures of the simulations: one for each, drawn from its result, for any settings."""
