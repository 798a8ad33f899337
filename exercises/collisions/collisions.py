"""Collisions: do two bodies touch, when, and what does the impact do to them?

Bodies do not spin. Positions in m, velocities in m/s, masses in kg (math.inf for a wall); vectors are arrays
of shape (d,) with d = 1, 2 or 3. `restitution` is e: speed of parting over speed of approach, 0 to 1.
Replace each ``raise`` with your code, and fix ``simulate_head_on``. README.md has the formulae.
"""

import math  # noqa: F401 - yours to use

import numpy as np


def detect_sphere_sphere(xa, ra, xb, rb):
    """Do two spheres touch?

    xa, xb: centres, shape (d,), m; ra, rb: radii, m
    Returns (touching, normal, depth): a bool, the unit vector from a to b, shape (d,), and the depth of the
    overlap, m, negative if they are apart. Any unit vector if the centres coincide.
    """
    raise NotImplementedError


def detect_sphere_plane(x, r, point, normal):
    """Does a sphere touch a half-space?

    x: centre, shape (d,), m; r: radius, m
    point: any point of the plane, shape (d,), m; normal: unit vector out of the solid, shape (d,)
    Returns (touching, normal, depth) as above, with the normal that was given.
    """
    raise NotImplementedError


def impulse_1d(ma, mb, va, vb, restitution):
    """The impulse that an impact on a line gives to b, N s; a gets the opposite. a is on the left.

    ma, mb: masses, kg; va, vb: velocities, m/s
    Returns a float; 0.0 if the bodies do not approach.
    """
    raise NotImplementedError


def resolve(ma, mb, va, vb, normal, restitution):
    """Velocities after an impact between smooth bodies.

    va, vb: velocities, shape (d,), m/s; normal: unit vector from a to b, shape (d,)
    Returns (va_next, vb_next), each of shape (d,); unchanged if the bodies do not approach.
    """
    raise NotImplementedError


def resolve_with_friction(ma, mb, va, vb, normal, restitution, mu):
    """Velocities after an impact between rough bodies: as resolve, with Coulomb's friction across the normal.

    mu: coefficient of friction, 0 or more
    Returns (va_next, vb_next), each of shape (d,).
    """
    raise NotImplementedError


def time_of_impact(xa, va, ra, xb, vb, rb, dt):
    """The time at which two spheres in straight motion first touch.

    xa, xb: centres now, m; va, vb: velocities, m/s, all of shape (d,); ra, rb: radii, m
    dt: how far to look ahead, s
    Returns the time from now in s, 0 to dt; 0.0 if they overlap and approach; None if they do not touch
    within dt, or are separating.
    """
    raise NotImplementedError


def simulate_head_on(m, x0, v0, radius, restitution, t_end, h):
    """Two balls on a line. This program runs, but there is no collision in it: mend it.

    m, x0, v0: masses kg, positions m and velocities m/s of the left and the right ball, shape (2,)
    radius: of both balls, m
    t_end, h: duration and step, s; t_end is a whole number of steps
    Returns (t, x, v) of shapes (N+1,), (N+1, 2), (N+1, 2); row 0 is the initial state.
    """
    t, x, v = [], [], []
    now, place, speed = 0.0, np.array(x0, dtype=float), np.array(v0, dtype=float)
    for _ in range(int(t_end / h)):
        place = place + speed * h
        now = now + h
        t.append(now)
        x.append(place)
        v.append(speed)
    return np.array(t), np.array(x), np.array(v)


def simulate_drop(z0, v0, radius, restitution, g, t_end, h):
    """A ball falls onto the floor z = 0, bounces, and comes to rest.

    z0, v0: height of its centre, m, and velocity upwards, m/s, at time 0; radius: m; g: m/s²
    t_end, h: duration and step, s; t_end is a whole number of steps
    Returns (t, z, v), each of shape (N+1,); row 0 is the initial state.
    """
    # One way to do it. Between contacts the flight is exact: z + v h - g h²/2 and v - g h.
    # For each step:
    #   1. at rest already? then z = radius and v = 0, and nothing more
    #   2. fly to the end of the step; if the ball is still above the floor there, that is the new state
    #   3. otherwise go back to the start of the step: at what speed, and after what time, does it touch?
    #   4. the speed upwards after the impact; if it is at most g h, the ball rests from now on
    #   5. if not, fly on for the rest of the step
    raise NotImplementedError
