"""The mistakes that actuators and odometry of ``digital-twin`` make, in words: see ``diagnosis.py``."""

from __future__ import annotations

ACTUATORS: dict[str, tuple[str, str]] = {
    # -- motor_step
    "LAG_EULER_UNSTABLE": (
        "The lag is stepped with dt / tau. That overshoots from dt = tau on and explodes beyond 2 tau.",
        "Solve it exactly: the share of the way that is gone after dt is 1 - exp(-dt / tau).",
    ),
    "LAG_WITHOUT_DT": (
        "A hundred times as long a step takes the speed no further: the share of the way does not follow dt.",
        "The share is 1 - exp(-dt / tau), with the dt and the tau of this very call; keep none from an "
        "earlier one.",
    ),
    "LAG_IMPLICIT": (
        "The share of the way is dt / (tau + dt): stable, but a little too slow at every step.",
        "Solve it exactly: the share is 1 - exp(-dt / tau).",
    ),
    "LAG_INVERTED": (
        "The share of the way that is gone and the share that is left are swapped.",
        "w + (1 - exp(-dt / tau)) * (u - w): after a long time w is u.",
    ),
    "LAG_MISSING": (
        "The speed jumps to the command at once.",
        "It covers the share 1 - exp(-dt / tau) of the way from w to u.",
    ),
    "CLIPS_SPEED_NOT_COMMAND": (
        "The speed is limited instead of the command. A motor that spins faster than u_max (pushed, or "
        "downhill) would stop short in no time.",
        "Clip u to [-u_max, u_max] before the lag, and leave w alone.",
    ),
    "SATURATION_MISSING": (
        "A command beyond u_max is obeyed.",
        "Clip u to [-u_max, u_max] before the lag.",
    ),
    "SATURATION_ONE_SIDED": (
        "Commands are limited forwards and not backwards.",
        "Clip on both sides: min(max(u, -u_max), u_max).",
    ),
    "DEADBAND_MISSING": (
        "A command inside the dead band moves the motor.",
        "Where abs(u) <= deadband, the command counts as 0.",
    ),
    "DEADBAND_ONE_SIDED": (
        "A command backwards inside the dead band moves the motor, or any command backwards is swallowed.",
        "Compare the size: abs(u) <= deadband.",
    ),
    "DEADBAND_SUBTRACTED": (
        "The dead band is taken off every command.",
        "Here a command outside the dead band counts whole: only abs(u) <= deadband becomes 0.",
    ),
    "DEADBAND_EDGE": (
        "A command exactly as large as the dead band moves the motor.",
        "Use <=: up to and including its edge, the dead band swallows.",
    ),
    "DEADBAND_STOPS_MOTOR": (
        "Inside the dead band the speed stops or stays, where it should run out.",
        "A swallowed command is the command 0: the speed lags towards 0.",
    ),
    # -- backlash
    "GAP_DOUBLED": (
        "The play is twice as wide as the gap.",
        "The gap is the whole play: half of it lies on either side, x - gap/2 and x + gap/2.",
    ),
    "BACKLASH_RATE_DEPENDENT": (
        "How far the output gets depends on how finely the same motion is sampled.",
        "Play has no time in it: y is the old output, clipped to [x - gap/2, x + gap/2], and nothing else.",
    ),
    "BACKLASH_MISSING": (
        "The output follows the input as if there were no play.",
        "The output rests until the input has crossed the gap: clip the state to [x - gap/2, x + gap/2].",
    ),
    "BACKLASH_IS_DEAD_BAND": (
        "It swallows small values of x wherever it came from: that is a dead band. Play has a memory.",
        "Compare x with the state, not with zero.",
    ),
    "BACKLASH_SNAPS": (
        "Once the gap is crossed, the output jumps to the input itself.",
        "The output is pushed by the edge of the gap: it stays gap/2 behind.",
    ),
    "GAP_HALVED": (
        "The play is half as wide as the gap.",
        "Half of the gap lies on either side of the input, x - gap/2 and x + gap/2.",
    ),
    "BACKLASH_ONE_SIDED": (
        "The output is pushed one way and not the other.",
        "The gap has two edges: clip the state to [x - gap/2, x + gap/2].",
    ),
    "STATE_IN_MODULE": (
        "The same call gives another output after another call: something is remembered in between.",
        "Start from the state that is passed in. There may be two gears, each with a state of its own.",
    ),
    "STATE_IS_NOT_OUTPUT": (
        "What is handed on as state is not the output.",
        "Return (y, y): where the output rests is all there is to remember.",
    ),
    # -- delay_line
    "DELAY_WHOLE_SAMPLES": (
        "The delay is a whole number of samples; what is left of the latency is dropped or rounded up.",
        "Interpolate: np.interp at the times k*dt - latency.",
    ),
    "DELAY_HOLDS_FIRST": (
        "Before the first sample has arrived, its value is there already.",
        "Nothing has arrived then: 0.0. np.interp has the argument left=0.0 for it.",
    ),
    "DELAY_ADVANCES": (
        "The signal arrives before it is sent.",
        "At time t you hear what was said at t - latency: mind the sign.",
    ),
    "DELAY_WRAPS": (
        "The end of the signal comes out at its beginning.",
        "np.roll goes round in a circle. Before the first sample there is 0.0.",
    ),
    "DELAY_IN_SAMPLES": (
        "The latency is taken as a number of samples.",
        "It is in seconds: latency / dt samples.",
    ),
    "DELAY_RAMPS_IN": (
        "Between nothing and the first sample, the output already rises.",
        "Before the first sample the signal is 0.0, not on the way from 0 to it.",
    ),
    # -- diff_drive_step
    "EULER_ODOMETRY": (
        "It rolls straight along the old heading and turns afterwards. In a turn that cuts every arc on its "
        "outer side, always to the same side.",
        "Go along the arc: its chord points along the heading in the middle of the turn and is "
        "sin(turn/2)/(turn/2) of its length.",
    ),
    "EULER_TURNS_FIRST": (
        "It turns first and rolls straight along the new heading.",
        "Go along the arc: its chord points along the heading in the middle of the turn.",
    ),
    "MIDPOINT_ODOMETRY": (
        "It rolls the whole length of the arc along the heading in the middle. The direction is right; the "
        "chord is shorter than its arc.",
        "Multiply by sin(turn/2)/(turn/2), which is 1 when there is no turn.",
    ),
    "LEFT_RIGHT_SWAPPED": (
        "A faster right wheel turns it to the right.",
        "Headings count to the left: turn rate = (v_right - v_left) / track.",
    ),
    "TRACK_HALVED": (
        "It turns twice as fast as it should.",
        "The wheels are a whole track apart: (v_right - v_left) / track.",
    ),
    "TRACK_DOUBLED": (
        "It turns half as fast as it should.",
        "The wheels are one track apart: (v_right - v_left) / track.",
    ),
    "SPEED_SUM_TURNS": (
        "It turns by the sum of the two wheel speeds, so that it turns even where both are equal.",
        "What turns it is their difference: turn rate = (v_right - v_left) / track.",
    ),
    "TURN_IN_DEGREES": (
        "The turn, or the angle of cosine and sine, is converted between degrees and radians.",
        "(v_right - v_left) / track * dt is in radians already, and so is the heading: convert nothing.",
    ),
    "DRIVE_SIN_COS_SWAPPED": (
        "Sine and cosine of the heading are swapped.",
        "x grows with the cosine of the heading and y with its sine.",
    ),
    "SINC_WITHOUT_PI": (
        "np.sinc is given the turn without the pi that it expects: np.sinc(s) is sin(pi s)/(pi s).",
        "sin(turn/2)/(turn/2) is np.sinc(turn / (2 * pi)).",
    ),
    "SPEEDS_ADDED": (
        "It goes twice as far as it should.",
        "The middle of the axle goes at the mean of the two wheel speeds.",
    ),
    "HEADING_WRAPPED": (
        "The heading jumps by whole turns.",
        "Leave it as it is: a heading beyond pi says how often the robot has turned.",
    ),
    "SMALL_TURN_CANCELS": (
        "For very slow turns the position is wrong by rounding: two nearly equal sines are subtracted and "
        "divided by a tiny turn rate.",
        "Write the chord as length * sin(turn/2)/(turn/2); np.sinc(turn / (2 * pi)) is that quotient and "
        "safe at 0.",
    ),
    "SLOW_TURN_AS_STRAIGHT": (
        "Slow turns are treated as straight lines, and not only the ones too slow to matter.",
        "Lower the threshold, or use np.sinc(turn / (2 * pi)), which needs none.",
    ),
    "STRAIGHT_WRONG": (
        "Turns are right, and straight ahead is wrong: that case has a mistake of its own.",
        "Straight ahead the way is speed * dt along the heading. np.sinc(turn / (2 * pi)) needs no case.",
    ),
    "STRAIGHT_DIVIDES_BY_ZERO": (
        "With equal wheel speeds the result is not a number: the turn rate is divided by.",
        "Treat a turn rate of 0 apart, or use np.sinc(turn / (2 * pi)), which is 1 there.",
    ),
}
