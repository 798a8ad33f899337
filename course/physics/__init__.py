"""The textbook behind the lessons: NumPy only, SI units and radians, every docstring with its shapes.

systems, state           right-hand sides, and what moves by them
integrators              one step: explicit and semi-implicit Euler, Verlet, Runge-Kutta; values between two
exact, invariants        closed forms, and what must not change
body, rotation, dynamics rigid bodies in space
contact, solver, simulator
                         from an overlap to an impulse to a world of balls
"""
