"""A playground of rigid bodies in a plane: scenes as data, one world, several views of it."""
