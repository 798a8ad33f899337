"""Wrong: one engine is left out."""

del _FACTS["mujoco"]
