"""Wrong: a licence by its everyday name."""

_FACTS["physx"]["licence"] = ("BSD", "https://github.com/NVIDIA-Omniverse/PhysX")
