"""Where a student is: objectives with their evidence, work done, the next step."""
