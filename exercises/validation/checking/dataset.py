"""The public data that ``course report validation`` shows: a tracked cart, its filters, and a slow error."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

#: A cart that is pushed at random and whose position is measured: step (s), std of the acceleration's kicks
#: (m/s²) and of the measurement (m).
DT, PUSH, NOISE = 0.1, 0.5, 0.05
#: What the slow errors lie around, in m.
BIAS = 0.02


@dataclass(frozen=True)
class Track:
    """What a Kalman filter made of many runs.

    Attributes:
        t: times, shape (N,), s.
        err: estimate minus truth, shape (runs, N, 2): position (m) and speed (m/s).
        P: the covariance the filter claims, shape (N, 2, 2); the same in every run.
        nu, S: innovations (runs, N, 1) and their covariance (N, 1, 1).
    """

    t: np.ndarray
    err: np.ndarray
    P: np.ndarray
    nu: np.ndarray
    S: np.ndarray


def track(believed_noise, runs=25, n=120, seed=11):
    """Filter the same recordings with a belief about the noise of the measurement (std, m)."""
    rng = np.random.default_rng(seed)
    move = np.array([[1.0, DT], [0.0, 1.0]])
    push = np.array([0.5 * DT**2, DT])
    process = PUSH**2 * np.outer(push, push)
    start = np.diag([0.1**2, 0.5**2])
    truth = rng.multivariate_normal(np.zeros(2), start, runs)
    estimate, P = np.zeros((runs, 2)), start
    err, covariances, nu, S = [], [], [], []
    for _ in range(n):
        truth = truth @ move.T + PUSH * rng.standard_normal((runs, 1)) * push
        z = truth[:, 0] + NOISE * rng.standard_normal(runs)
        estimate, P = estimate @ move.T, move @ P @ move.T + process
        s = P[0, 0] + believed_noise**2
        innovation = z - estimate[:, 0]
        gain = P[:, 0] / s
        estimate = estimate + innovation[:, None] * gain
        P = P - np.outer(gain, P[0])
        err.append(estimate - truth)
        covariances.append(P)
        nu.append(innovation[:, None])
        S.append([[s]])
    t = DT * np.arange(1, n + 1)
    return Track(t, np.stack(err, 1), np.array(covariances), np.stack(nu, 1), np.array(S))


def slow_errors(n=400, keep=0.9, bias=BIAS, size=0.05, seed=4):
    """Errors (m) that each keep a share of the one before, around a bias."""
    rng = np.random.default_rng(seed)
    e = np.empty(n)
    e[0] = rng.standard_normal()
    for i in range(1, n):
        e[i] = keep * e[i - 1] + np.sqrt(1 - keep**2) * rng.standard_normal()
    return bias + size * e
