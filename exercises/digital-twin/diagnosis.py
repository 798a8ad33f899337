"""The mistakes that the checks of ``digital-twin`` recognise, in words.

Each code says what the submission looks like and what to change. ``sensor_probes.py``, ``actuator_probes.py``
and ``twin_probes.py`` find which one it is.
"""

from __future__ import annotations

from course.grading import kit
from course.grading.kit import Diagnosis, Divergence

_sensors = kit.companion("digital-twin", "sensor_words").SENSORS
_actuators = kit.companion("digital-twin", "actuator_words").ACTUATORS

#: code: (what it looks like, what to change)
WORDS: dict[str, tuple[str, str]] = {
    **_sensors,
    **_actuators,
    # -- any function
    "MUTATES_INPUT": (
        "The caller still needs what was passed in.",
        "Work on a copy: x = np.array(x) makes one, dict(twin) does for a dict (its memory needs one of its "
        "own), and x = x + ... makes a new array where x += ... changes the old one.",
    ),
    "RETURNS_ARGUMENT": (
        "Changing the result later would change the caller's array too.",
        "Return a new array: np.array(x) or x.copy() makes one.",
    ),
    "RETURNS_SWAPPED": (
        "It returns the right two things in the wrong order.",
        "Return them in the order that the README's contract gives.",
    ),
    # -- sync
    "TIME_NOT_ADVANCED": (
        "The twin's time stands still.",
        'Return "t": max(twin["t"], t_measured).',
    ),
    "TIME_RUNS_BACK": (
        "A late measurement sets the twin's clock back.",
        'Return "t": max(twin["t"], t_measured): a late one changes no clock.',
    ),
    "NO_CORRECTION": (
        "What was measured makes no difference to the position: this is a model that runs on its own.",
        "Move the position by a share of the surprise, z minus what the twin expected.",
    ),
    "SURPRISE_INVERTED": (
        "A measurement ahead of the twin pushes it further back.",
        "The surprise is z minus the prediction; add a share of it.",
    ),
    "BELIEVES_MEASUREMENT": (
        "The position is the measured one, noise and all.",
        "Move only a share of the way to z: the prediction knows something, too.",
    ),
    "NO_PREDICTION": (
        "Between two measurements the twin stands still.",
        "First predict to t_measured with speed, drive and friction, then correct.",
    ),
    "SHARE_TOO_LARGE": (
        "The position is moved nearly all the way to the measurement, and takes nearly all of its noise.",
        "Move only a share of the way to z, a third say: the prediction knows something, too.",
    ),
    "STEP_FIXED": (
        "It predicts over a fixed time, whenever the measurement was taken.",
        'Measurements come at uneven times: predict over t_measured - twin["t"].',
    ),
    "DRIVE_CHANGED": (
        "It is for others to change.",
        'Pass drive and sigma on as they are: {**twin, "t": ..., "position": ...}.',
    ),
    "MEMORY_GROWS": (
        "Everything ever measured is kept.",
        "Keep the last second or two of the history, and drop what is older.",
    ),
    "DRIVE_NOT_USED": (
        "The prediction does not feel the drive.",
        'dv/dt = drive - friction * speed, with twin["drive"].',
    ),
    "FRICTION_SPEEDS_UP": (
        "In the prediction, friction makes a rolling cart faster.",
        "Friction acts against the motion: dv/dt = drive - friction * speed.",
    ),
    "FRICTION_NOT_LEARNED": (
        "The friction stays what it was at the start, so the twin keeps running ahead or behind.",
        "Surprises that keep their sign mean that a parameter is wrong. A cart that lags behind has more "
        "friction than thought: subtract a small share of the surprise from it.",
    ),
    "FRICTION_LEARNS_BACKWARDS": (
        "The friction moves away from the true one.",
        "Mind the sign: a cart ahead of its prediction has less friction.",
    ),
    "LEARNS_FORWARDS_ONLY": (
        "When the cart rolls backwards, the friction moves away from the true one.",
        "Friction slows down either way: whether a surprise means more of it or less depends on the sign of "
        "the speed.",
    ),
    "LATE_USED_AS_CURRENT": (
        "A measurement that comes late is compared with where the twin is now, not with where it was then, "
        "and drags it back.",
        'If t_measured < twin["t"], leave it out; or keep a short history in memory, correct the past, and '
        "run forward again.",
    ),
    "MEMORY_DROPPED": (
        "Nothing is kept in memory, so each measurement is weighed as if it were the first, and friction and "
        "position stay as noisy as at the start.",
        'Return what the next call needs (the covariance of a Kalman filter, say) as "memory", and read it '
        "back; only where it is {} begin afresh.",
    ),
    "GLOBAL_MEMORY": (
        "The same call gives another result the second time: something is remembered outside the twin.",
        'Keep everything in twin["memory"]: there may be two twins, and a replay must repeat itself.',
    ),
    "FORGETS_TO_DOUBT": (
        "It learns well at first and hardly at all later: by then no surprise counts any more.",
        "Let the uncertainty of the friction grow a little in every prediction (process noise).",
    ),
    # -- command
    "TARGET_IGNORED": (
        "The drive does not depend on the speed that is asked for.",
        "At a steady speed, drive = friction * speed.",
    ),
    "USES_TWIN_SPEED": (
        "It holds the speed that the robot has, not the one asked for.",
        "Use target_speed: friction * target_speed.",
    ),
    "FRICTION_IGNORED": (
        "The drive does not depend on the twin's friction, so nothing that the twin has learned reaches the "
        "robot.",
        'Use twin["friction"]: that is the way back from twin to robot.',
    ),
    "DIVIDES_BY_FRICTION": (
        "More friction gives less drive.",
        "At a steady speed dv/dt = 0, so drive = friction * speed: multiply.",
    ),
    "BACKWARDS_NOT_DRIVEN": (
        "For a speed backwards the drive has the wrong sign, or is missing.",
        "Friction acts against the motion both ways: drive = friction * target_speed, sign and all.",
    ),
    "BRAKES": (
        "The drive points the wrong way.",
        "Friction slows down, so the drive points along the target speed.",
    ),
    "PUSHES_AWAY": (
        "Where the twin is slower than asked, the drive is smaller: the correction has the wrong sign.",
        'Add a share of target_speed - twin["speed"], not of the speed minus the target.',
    ),
    "ADDS_CURRENT_DRIVE": (
        "The result depends on the drive that acts just now.",
        "Return the drive itself, not a change of it: friction * target_speed.",
    ),
}


def named(code: str, divergence: Divergence | None = None) -> Diagnosis:
    """The diagnosis of that code."""
    looks_like, advice = WORDS[code]
    return Diagnosis(code, looks_like, advice, divergence)
