"""Where the two simulations of ``collisions`` must lead: their contacts in closed form, without any step."""

from __future__ import annotations

import math

from course.scoring import kit

paths = kit.companion("collisions", "paths")


def closing(scene):
    """Speed of approach of a ``HeadOn``, m/s; zero or negative if they never meet."""
    return scene.v0[0] - scene.v0[1]


def meeting(scene):
    """When the balls of a ``HeadOn`` touch, and their velocities after the impact."""
    gap = scene.x0[1] - scene.x0[0] - 2 * scene.radius
    speed = closing(scene)
    if speed <= 0:
        return paths.Meeting(math.inf, scene.v0)
    ma, mb = scene.m
    impulse = (1 + scene.restitution) * speed / (1 / ma + 1 / mb)
    return paths.Meeting(gap / speed, (scene.v0[0] - impulse / ma, scene.v0[1] + impulse / mb))


def bounces(scene, t_end, h):
    """The contacts of a ``Drop`` up to t_end, and when it comes to rest."""
    times, speeds = contacts(scene, t_end, scene.g * h)
    return paths.Bounces(times, speeds, *settling(scene, t_end, h))


def contacts(scene, t_end, slowest):
    """Times (s) of the contacts up to t_end, speeds (m/s) upwards after each; below ``slowest`` none."""
    up = scene.fastest
    t, speeds, times = (scene.v0 + up) / scene.g, [], []
    while t <= t_end:
        up *= scene.restitution
        times.append(t)
        if up <= slowest:
            speeds.append(0.0)
            break
        speeds.append(up)
        t += 2 * up / scene.g
    return tuple(times), tuple(speeds)


def settling(scene, t_end, h):
    """From when on the ball may rest, by its speed after a contact, and must, by that before it: (s, s)."""
    slowest, may, before = scene.g * h, math.inf, scene.fastest
    t = (scene.v0 + before) / scene.g
    while t <= t_end:
        after = scene.restitution * before
        if after <= slowest * (1 + 1e-6):
            may = min(may, t)
        if before <= slowest * (1 - 1e-6) or after == 0.0:
            return may, t
        t, before = t + 2 * after / scene.g, after
    return may, math.inf
