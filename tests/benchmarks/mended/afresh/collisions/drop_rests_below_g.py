"""The ball rests when its speed after the contact is at most g times one second instead of at most g h, so
it comes to rest much too early.
"""

import math

import numpy as np


class Ball:
    def __init__(self, z, v, radius, e, g):
        self.z, self.v = float(z), float(v)
        self.radius, self.e, self.g = radius, e, g
        self.asleep = z == radius and v == 0
        self.limit = g

    def step(self, h):
        if self.asleep:
            return
        z = self.z + self.v * h - self.g * h**2 / 2
        if z > self.radius:
            self.z, self.v = z, self.v - self.g * h
            return
        speed = math.sqrt(self.v**2 + 2 * self.g * (self.z - self.radius))
        left = h - (self.v + speed) / self.g
        up = self.e * speed
        if up <= self.limit:
            self.asleep = True
            self.z, self.v = self.radius, 0.0
        else:
            self.z = self.radius + up * left - self.g * left**2 / 2
            self.v = up - self.g * left


def simulate_drop(z0, v0, radius, restitution, g, t_end, h):
    N = round(t_end / h)
    ball = Ball(z0, v0, radius, restitution, g)
    rows = [(0.0, ball.z, ball.v)]
    for i in range(1, N + 1):
        ball.step(h)
        rows.append((i * h, ball.z, ball.v))
    t, z, v = np.array(rows).T
    return t, z, v
