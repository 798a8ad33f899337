"""Two iterative solvers of many constraints: a stack and a chain.

An engine has thousands of contacts and joints that all depend on one another. Solving for all of them
together is expensive, so an engine solves them in turn, again and again, and stops when its time is up. These
are the two smallest cases that show the error such a solver leaves.

Source: Catto, Iterative Dynamics with Temporal Coherence (Game Developers Conference), 2005 (projected
Gauss-Seidel, called sequential impulses from 2006 on); Müller et al., Position Based Dynamics, 2007; Macklin
et al., Small Steps in Physics Simulation, 2019.
"""

import math
from dataclasses import dataclass

import numpy as np

from course.physics.state import Array


def stack_impulses(boxes: int, iterations: int) -> Array:
    """Sequential impulses in a stack at rest, starting from zero, over one step.

    Each box has mass 1 and gravity has just given each a velocity of -1. Contact k is under box k; an
    iteration removes the approach from every contact once, from the ground up.

    Returns:
        The impulse of every contact after 0, 1, ... iterations, shape (iterations + 1, boxes), in units of
        one box's weight over the step. Contact k must carry ``boxes - k`` of them.

    Raises:
        ValueError: no box, or a negative number of iterations.
    """
    if boxes < 1 or iterations < 0:
        raise ValueError("A stack needs a box or more, and 0 or more iterations.")
    velocity = [0.0] + [-1.0] * boxes  # the ground first
    impulse = [0.0] * boxes
    history = [impulse.copy()]
    for _ in range(iterations):
        for k in range(boxes):
            # The ground does not move, so the lowest contact has only one mass to shift.
            give = 1.0 if k == 0 else 2.0
            change = max(-impulse[k], (velocity[k] - velocity[k + 1]) / give)
            impulse[k] += change
            velocity[k + 1] += change
            if k > 0:
                velocity[k] -= change
        history.append(impulse.copy())
    return np.array(history)


def iterations_to(boxes: int, tolerance: float = 0.01, limit: int = 100_000) -> int:
    """Iterations until the ground carries the stack's weight to within ``tolerance`` (a fraction of it).

    Raises:
        ValueError: not reached within ``limit`` iterations.
    """
    done = 0
    tries = 64
    while done < limit:
        lowest = stack_impulses(boxes, tries)[:, 0]
        good = np.flatnonzero(np.abs(lowest - boxes) <= tolerance * boxes)
        if good.size:
            return int(good[0])
        done, tries = tries, 2 * tries
    raise ValueError(f"{boxes} boxes do not settle to {tolerance:g} within {limit} iterations.")


@dataclass(slots=True)
class Chain:
    """Equal point masses on equal links without mass, hung at one end, in a vertical plane.

    Position-based: every substep lets the masses fall freely, then restores each link to its length in turn,
    ``iterations`` times, and computes the velocities from the change of the positions.

    Attributes:
        links: how many.
        length: of the whole chain, m.
        g: m/s².
    """

    links: int = 20
    length: float = 2.0
    g: float = 9.81

    def stretch(self, duration: float, h: float, substeps: int, iterations: int) -> Array:
        """Release the chain from a horizontal line, and record its longest link.

        Args:
            duration, h: s; h is a frame, which is divided into substeps.
            substeps, iterations: how the work of a frame is divided: their product is its cost.

        Returns:
            By how much the longest link is too long after each frame (a fraction of its length), shape (n +
            1,).

        Raises:
            ValueError: the frame does not divide the duration.
        """
        from course.physics.simulator import step_count

        frames = step_count(duration, h)
        rest = self.length / self.links
        x = [i * rest for i in range(self.links + 1)]
        y = [0.0] * (self.links + 1)
        vx, vy = [0.0] * len(x), [0.0] * len(x)
        worst = [0.0]
        for _ in range(frames):
            for _ in range(substeps):
                self._substep(x, y, vx, vy, h / substeps, iterations)
            lengths = np.hypot(np.diff(x), np.diff(y))
            worst.append(float(lengths.max()) / rest - 1.0)
        return np.array(worst)

    def _substep(
        self, x: list[float], y: list[float], vx: list[float], vy: list[float], h: float, iterations: int
    ) -> None:
        """Fall, restore the links, compute velocities. Plain lists: one link is too small for NumPy."""
        old_x, old_y = x.copy(), y.copy()
        for i in range(1, len(x)):
            vy[i] -= self.g * h
            x[i] += h * vx[i]
            y[i] += h * vy[i]
        rest = self.length / self.links
        for _ in range(iterations):
            for i in range(1, len(x)):
                dx, dy = x[i] - x[i - 1], y[i] - y[i - 1]
                # The first mass hangs from a fixed point; of two masses, each moves half-way.
                near, far = (0.0, 1.0) if i == 1 else (0.5, 0.5)
                excess = 1.0 - rest / math.hypot(dx, dy)
                x[i - 1] += near * excess * dx
                y[i - 1] += near * excess * dy
                x[i] -= far * excess * dx
                y[i] -= far * excess * dy
        for i in range(1, len(x)):
            vx[i] = (x[i] - old_x[i]) / h
            vy[i] = (y[i] - old_y[i]) / h
