"""The checks of an exercise as pytest has them, collected once for a session.

plugin, collected  their markers, running one, and the modules that the checks of an exercise share
"""
