"""The simulations that ``course sim`` runs: each measures itself against theory and says what it found.

A simulation is data (:class:`course.simulations.base.Simulation`) and a function from settings to a
:class:`course.simulations.base.Result`. None of them prints or draws.
"""
