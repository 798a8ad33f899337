"""The checks of an exercise as pytest has them, collected once for a session."""
