"""Wrong: MuJoCo's licence of years ago."""

_FACTS["mujoco"]["licence"] = ("Proprietary", "https://www.roboti.us/license.html")
