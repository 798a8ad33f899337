"""Where a student is: objectives with their evidence, what is done, what is next."""
