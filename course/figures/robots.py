"""Figure of the lesson on why to simulate: a standing robot, tried sixteen hundred times at once.

The robot is one stiff body on its ankles, an upside-down pendulum. Its controller pushes back against the
lean with ``kp`` and against the rate of leaning with ``kd``, through an ankle that cannot push harder than
the foot is long, and it acts on the state of some time ago.
"""

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from numpy.typing import ArrayLike, NDArray

from course.figures.style import PALETTE, Array, new_figure, note, title, word
from course.physics.dynamics import DrivenArm, HandPath, TwoLinkArm
from course.physics.integrators import RK4, State, trajectory

#: What the figure shows and its caption quotes: tries a side, and the delay of the real robot.
TRIES, DELAY_S = 40, 0.1
FALLEN, SWAYING, STANDING = 0, 1, 2

_MASS, _HEIGHT, _G = 50.0, 0.9, 9.81  # kg, m (centre of mass), m/s²
_MOST = 60.0  # N m: more would lift the toes or the heel
_PUSH = 0.3  # rad/s, what the robot has to cope with
_STEP, _DURATION = 0.005, 5.0  # s


def gains() -> tuple[Array, Array]:
    """The settings tried: kp (N m/rad) and kd (N m s/rad), each of shape (TRIES, TRIES)."""
    kp, kd = np.meshgrid(np.linspace(75, 3000, TRIES), np.linspace(25, 1000, TRIES))
    return kp, kd


def fate(kp: Array, kd: Array, delay: float) -> NDArray[np.int_]:
    """How a robot ends with each setting after one push: FALLEN, SWAYING or STANDING.

    Args:
        kp, kd: N m/rad and N m s/rad, any shape; all robots are simulated together.
        delay: s, a whole number of steps.
    """
    steps, lag = round(_DURATION / _STEP), round(delay / _STEP)
    lean = np.zeros((steps + 1, *kp.shape))
    rate = np.full_like(lean, _PUSH)
    for i in range(steps):
        seen = max(i - lag, 0)
        torque = np.clip(-kp * lean[seen] - kd * rate[seen], -_MOST, _MOST)
        turn = _G / _HEIGHT * np.sin(lean[i]) + torque / (_MASS * _HEIGHT**2)
        rate[i + 1] = rate[i] + _STEP * turn
        lean[i + 1] = lean[i] + _STEP * rate[i + 1]
    fell = np.max(np.abs(lean), axis=0) > 0.5
    # Upright and still: within 0.01 rad over the whole last second.
    calm = np.max(np.abs(lean[-round(1.0 / _STEP) :]), axis=0) < 0.01
    return np.where(fell, FALLEN, np.where(calm, STANDING, SWAYING))


def standing() -> Figure:
    """Which settings keep the robot on its feet, without delay and with the delay of a real one."""
    figure, axes = new_figure(3.9, 1, 2, sharey=True)
    kp, kd = gains()
    before = fate(kp, kd, 0.0)
    after = fate(kp, kd, DELAY_S)
    _map(axes[0], kp, kd, before, "The simulator leaves out the delay")
    _map(axes[1], kp, kd, after, f"The robot acts {DELAY_S:g} s late")
    _name(axes[0], [(1900, 540, "stands still"), (140, 830, "leans,\nsways"), (70, 130, "falls")])
    _name(
        axes[1],
        [
            (1120, 540, "stands still"),
            (2330, 450, "trembles"),
            (420, 830, "leans,\nsways"),
            (1500, 55, "falls"),
        ],
    )
    axes[0].set_ylabel("reaction to the speed of leaning (N m s/rad)")
    stood = before == STANDING
    share = float(np.mean(after[stood] == STANDING))
    return title(figure, f"Of the gains that work in the simulator, {100 * share:.0f} % work on the robot")


def _map(axes: Axes, kp: Array, kd: Array, what: NDArray[np.int_], heading: str) -> None:
    colors = ListedColormap(["#F1F1F1", PALETTE["orange"], PALETTE["blue"]])
    axes.pcolormesh(kp, kd, what, cmap=colors, vmin=0, vmax=2, shading="nearest")
    axes.set(xlabel="reaction to the lean (N m/rad)", title=heading)
    axes.set(xlim=(38, 3038), ylim=(12, 1012), xticks=range(500, 3000, 500))
    axes.grid(visible=False)


def _name(axes: Axes, regions: list[tuple[float, float, str]]) -> None:
    for x, y, text in regions:
        color = "white" if text == "stands still" else PALETTE["black"]
        axes.text(x, y, text, color=color, fontsize=8.5, fontweight="bold")


# ---
# Figures of the lesson on three kinds of simulation: one arm, planned, driven and let go.


#: What the figures show and the lesson quotes: the ends of the hand's path (m) and a forgotten load (kg).
START, END, LOAD_KG = (1.2, -0.8), (0.6, 1.2), 0.1
_ARM_STEP = 0.01  # s
_ARM = TwoLinkArm()
#: The arm with a point mass (kg) in its hand.
loaded = _ARM.carrying


def path(duration: float) -> HandPath:
    """The straight path of the hand from START to END, in so many seconds."""
    return HandPath(START, END, duration)


def driven(load: float, *, feedback: bool = False) -> Array:
    """The path of the hand within a second under the planned torques, m, shape (n + 1, 2).

    Args:
        load: kg in the hand that the plan does not know of.
        feedback: add 100 N m/rad and 20 N m s/rad times the errors of the joints.
    """
    plan = path(1.0)
    q, v, _ = plan.joints(_ARM, 0.0)
    arm = loaded(load) if load > 0 else _ARM
    gains = (100.0, 20.0) if feedback else (0.0, 0.0)
    run = trajectory(
        RK4(), DrivenArm(arm, _ARM, plan, *gains), State.of(q, v), _ARM_STEP, round(1.0 / _ARM_STEP)
    )
    return arm.hand(run.q)


def planned() -> Figure:
    """Kinematics: nine poses of the arm as its hand follows a straight line, and the joint angles."""
    figure, (left, right) = new_figure(3.6, 1, 2, wspace=0.28)
    plan = path(1.0)
    shares = np.linspace(0.0, 1.0, 9)
    poses, _, _ = plan.joints(_ARM, shares)
    for k, pose in enumerate(poses):
        elbow, hand = _ARM.elbow(pose), _ARM.hand(pose)
        strong = k in (0, len(poses) - 1)
        color, width = (PALETTE["black"], 1.6) if strong else ("#A9A9A9", 0.9)
        left.plot([0, elbow[0], hand[0]], [0, elbow[1], hand[1]], color=color, linewidth=width)
        left.plot(*hand, marker="o", color=PALETTE["vermillion"])
    left.plot([START[0], END[0]], [START[1], END[1]], color=PALETTE["vermillion"], linewidth=1.0)
    left.plot(0, 0, marker="s", color=PALETTE["black"], markersize=7)
    left.text(-0.18, 0.14, "shoulder", fontsize=8.5, ha="right")
    left.text(1.28, -0.9, "start", fontsize=8.5)
    left.text(0.52, 1.3, "end", fontsize=8.5)
    left.set(xlim=(-1.0, 2.0), ylim=(-1.5, 1.6), aspect="equal")
    left.set(xlabel="x (m)", ylabel="y (m)", title="The hand: a straight line")
    t = np.linspace(0.0, 1.0, 101)
    q = np.degrees(plan.joints(_ARM, t)[0])
    right.plot(t, q[:, 0], color=PALETTE["blue"])
    right.plot(t, q[:, 1], color=PALETTE["green"], linestyle="--")
    word(right, 0.63, -40.0, "shoulder", "blue")
    word(right, 0.05, 99.0, "elbow", "green")
    most = int(np.argmax(q[:, 1]))
    note(right, "bends, then\nstraightens", (float(t[most]), float(q[most, 1])), (0.44, 62))
    right.set(xlim=(0, 1), ylim=(-90, 145), yticks=range(-90, 136, 45))
    right.set(xlabel="time (s)", ylabel="joint angle (degrees)", title="The joints: curved paths")
    return title(figure, "On a straight line of the hand the joints turn back and forth")


def torques() -> Figure:
    """Inverse and forward: the shoulder's torque at three speeds; where a forgotten load takes the hand."""
    figure, (left, right) = new_figure(3.8, 1, 2, wspace=0.28)
    share = np.linspace(0.0, 1.0, 201)
    for duration, line, color in ((0.5, "-", "vermillion"), (1.0, "--", "blue"), (2.0, "-.", "green")):
        q, v, a = path(duration).joints(_ARM, share * duration)
        left.plot(share, _ARM.inverse(q, v, a)[:, 0], color=PALETTE[color], linestyle=line)
    left.plot(share, _ARM.inverse(q, 0 * v, 0 * a)[:, 0], color=PALETTE["black"], linewidth=0.9)
    word(left, 0.5, 76.0, "in 0.5 s", "vermillion")
    word(left, 0.70, -14.0, "in 1 s", "blue")
    word(left, 0.02, -1.5, "in 2 s", "green")
    note(left, "to hold\nits weight", (0.8, 12.9), (0.7, 33))
    left.set(xlim=(0, 1), ylim=(-70, 90))
    left.set_title("Inverse: what it takes")
    left.set(xlabel="share of the duration (1)", ylabel="shoulder torque (N m)")
    for load, feedback, line, color, width in (
        (0.0, False, "-", "blue", 3.2),
        (0.01, False, "--", "purple", 1.6),
        (LOAD_KG, False, ":", "vermillion", 1.8),
        (LOAD_KG, True, "-.", "black", 1.2),
    ):
        hand = driven(load, feedback=feedback)
        right.plot(hand[:, 0], hand[:, 1], color=PALETTE[color], linestyle=line, linewidth=width)
        right.plot(*hand[-1], marker="o", color=PALETTE[color])
    right.plot(*END, marker="o", markersize=10, markerfacecolor="none", color=PALETTE["black"])
    for x, y, text, color in (
        (-0.5, 0.1, "bare arm;\n0.1 kg with\nfeedback", "blue"),
        (1.05, 0.75, "0.01 kg more", "purple"),
        (1.35, 0.08, "0.1 kg more", "vermillion"),
    ):
        word(right, x, y, text, color)
    right.set(xlim=(-0.6, 2.4), ylim=(-1.6, 1.6), aspect="equal")
    right.set(xlabel="x of the hand (m)", ylabel="y of the hand (m)", title="Forward: what happens")
    return title(figure, "Faster motion needs more torque, and a forgotten load spoils the plan")


def felt(bend: ArrayLike) -> Array:
    """Mass that a wall straight ahead of the arm feels, kg, at bends of the elbow (rad), shape (...)."""
    bend = np.asarray(bend, dtype=float)
    q = np.stack([-bend / 2, bend], axis=-1)
    row = _ARM.jacobian(q)[..., :1, :]
    turned = np.linalg.solve(_ARM.mass_matrix(q), np.swapaxes(row, -1, -2))
    return np.asarray(1.0 / (row @ turned)[..., 0, 0])


def wall() -> Figure:
    """The arm before a wall, bent and nearly straight, and the mass that the wall feels."""
    figure, (left, right) = new_figure(3.4, 1, 2, wspace=0.28)
    for degrees, color, line, lift in (
        (90, "blue", "-", 1.1),
        (45, "green", "--", 0.0),
        (10, "vermillion", "-.", -0.9),
    ):
        bend = math.radians(degrees)
        pose = np.array([-bend / 2, bend])
        back = 2.0 - float(_ARM.hand(pose)[0])
        elbow, hand = _ARM.elbow(pose), _ARM.hand(pose)
        x, y = np.array([0, elbow[0], hand[0]]) + back, np.array([0, elbow[1], hand[1]]) + lift
        left.plot(x, y, color=PALETTE[color], linestyle=line, marker="o")
        left.plot(back, lift, color=PALETTE["black"], marker="s", markersize=7)
        left.text(back, lift + 0.15, f"bent by {degrees}°", fontsize=8.5)
    left.axvspan(2.0, 2.2, color="#C9C9C9")
    left.text(1.97, 1.7, "wall", fontsize=8.5, ha="right")
    left.set(xlim=(-0.4, 2.2), ylim=(-1.4, 2.0))
    left.set(xlabel="x (m)", ylabel="y (m)", title="The arm meets a wall")
    bends = np.radians(np.linspace(1.0, 150.0, 400))
    right.plot(np.degrees(bends), felt(bends), color=PALETTE["blue"])
    right.axhline(2.0, color=PALETTE["black"], linewidth=0.9, linestyle=":")
    right.text(147, 2.35, "the arm weighs 2 kg", fontsize=8.5, ha="right")
    ten = float(felt(math.radians(10.0)))
    note(right, "10 kg\nat 10°", (10.0, ten), (30, 30))
    right.set(yscale="log", xlim=(0, 150), ylim=(0.3, 1500), xticks=range(0, 151, 30))
    right.set_yticks([1, 10, 100, 1000], ["1", "10", "100", "1000"])
    right.set(xlabel="bend of the elbow (degrees)", ylabel="mass felt (kg)", title="What the wall feels")
    return title(figure, "A bent arm gives way, a straight one hits with all it is bolted to")


# ---
# Figure of the summary: the same six mistakes in two questions about one robot.


_GRAVITY = 9.81
_FINE = 1e-5  # s; small enough that its own error does not count
_LOOKS = {
    "numerical": (PALETTE["blue"], "o"),
    "sensor": (PALETTE["green"], "s"),
    "environment": (PALETTE["orange"], "^"),
    "model": (PALETTE["vermillion"], "D"),
}

_TILT = math.radians(1.0)
#: What is wrong -> which kind of mistake it is, what it changes for ``stop``, and what for ``bounce``, where
#: neither the floor's friction nor a late brake matters.
MISTAKES: dict[str, tuple[str, dict[str, float], dict[str, float] | None]] = {
    "step of 1 ms": ("numerical", {"h": 1e-3}, {"h": 1e-3}),
    "step of 10 ms": ("numerical", {"h": 1e-2}, {"h": 1e-2}),
    "speed sensor 1 % off": ("sensor", {"speed": 2.0 * 1.01}, {"speed": 3.0 * 1.01}),
    "floor tilted by 1°": ("environment", {"tilt": _TILT}, {"tilt": _TILT}),
    "friction 10 % too high": ("model", {"friction": 0.5 * 1.1}, None),
    "delay of 50 ms left out": ("model", {"delay": 0.05}, None),
}


def stop(
    *, h: float = _FINE, speed: float = 2.0, friction: float = 0.5, tilt: float = 0.0, delay: float = 0.0
) -> float:
    """Distance that a braking robot slides, m, by semi-implicit Euler.

    Args:
        h: step, s.
        speed: at which it is told to brake, m/s.
        friction: Coulomb's coefficient of the floor.
        tilt: of the floor, downhill, rad.
        delay: between the command and the brake, s.
    """
    distance = speed * delay
    while speed > 0.0:
        speed = max(speed - h * _GRAVITY * (friction * math.cos(tilt) - math.sin(tilt)), 0.0)
        distance += h * speed
    return distance


def bounce(*, h: float = _FINE, speed: float = 3.0, tilt: float = 0.0) -> float:
    """Height that a foot of 1 kg rebounds to, m, by semi-implicit Euler; its contact is a spring of 1e5 N/m.

    Args:
        h: step, s.
        speed: at which it lands, m/s.
        tilt: of the floor, rad; turns the rebound by twice as much.
    """
    depth, velocity = 0.0, -speed
    while depth < 0.0 or velocity < 0.0:
        velocity -= h * (_GRAVITY + 1e5 * min(depth, 0.0))
        depth += h * velocity
    return (velocity * math.cos(2.0 * tilt)) ** 2 / (2.0 * _GRAVITY)


def budgets() -> dict[str, dict[str, float]]:
    """Question -> mistake -> how far the answer is off, as a share of it."""
    far, high = 2.0**2 / (2 * 0.5 * _GRAVITY), 3.0**2 / (2 * _GRAVITY)
    stops = {name: stop(**wrong) for name, (_, wrong, _) in MISTAKES.items()}
    heights = {name: high if wrong is None else bounce(**wrong) for name, (_, _, wrong) in MISTAKES.items()}
    return {
        "Where does it stop?": {name: abs(x / far - 1.0) for name, x in stops.items()},
        "How high does it bounce?": {name: abs(x / high - 1.0) for name, x in heights.items()},
    }


def two_questions() -> Figure:
    """Both budgets, side by side, on one logarithmic axis."""
    figure, panels = new_figure(3.4, 1, 2, sharey=True, left=0.27, wspace=0.1)
    for axes, (question, found) in zip(panels, budgets().items(), strict=True):
        for row, (name, share) in enumerate(found.items()):
            _dot(axes, row, 100.0 * share, *_LOOKS[MISTAKES[name][0]])
        axes.set_title(question)
        axes.set(xscale="log", xlim=(0.03, 4e5), ylim=(-0.6, len(MISTAKES) - 0.4))
        axes.set_xticks([0.1, 1, 10, 100, 1000, 10_000], ["0.1", "1", "10", "100", "1000", ""])
        axes.set_xlabel("error of the answer (%)")
    panels[0].set_yticks(np.arange(len(MISTAKES)), list(MISTAKES))
    return title(figure, "Which of the same mistakes matters depends on the question")


def _dot(axes: Axes, row: int, percent: float, color: str, marker: str) -> None:
    if percent == 0.0:
        axes.text(0.045, row, "no effect", va="center", fontsize=8.5)
        return
    axes.plot([0.03, percent], [row, row], color=color, linewidth=1.2)
    axes.plot(percent, row, color=color, marker=marker, markersize=7)
    shown = f"{percent:.2f}" if percent < 0.95 else f"{percent:.1f}" if percent < 9.5 else f"{percent:.0f}"
    axes.text(percent * 1.9, row, shown, va="center", fontsize=8.5)
