"""Mistakes in `clear-the-forces`: words beside the programs that they are true of."""

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "NEVER_CLEARED",
    "The forces of all earlier steps still push: no step clears the sum.",
    "Set the sum to zero inside the loop, once in every step, after its use or before the force is added.",
).edit("final_speed", {"speed = 0.0": "speed = summed = 0.0", "        summed = 0.0": ""})
mistakes(
    "CLEARED_BEFORE_USE",
    "The speed is zero: in each step the sum is cleared before it is used, or the speed is cleared, too.",
    "In each step add the force, update the speed, then clear the sum and nothing else.",
).edit("final_speed", {"summed = 0.0\n        summed += force": "summed = force\n        summed = 0.0"})
mistakes(
    "SPEED_CLEARED",
    "The speed is that of a single step: the others are lost.",
    "Clear only the forces. The speed is part of the body's state and stays.",
).edit("final_speed", {"summed = 0.0": "speed = summed = 0.0"})
mistakes(
    "RESET_TO_THE_FORCE",
    "After each step the sum is set to the force. The next step adds the force once more, and pushes with twice the force.",
    "Set it to zero.",
)
mistakes(
    "STEP_IGNORED",
    "The force acts for a whole second in each step.",
    "Multiply by h, as the file did.",
)
mistakes(
    "IMPULSE_TAKEN_OUT",
    "After each step you take h times the force out of the sum: most of it stays.",
    "Set the sum to zero.",
).edit(
    "final_speed",
    {
        "speed = 0.0": "speed = summed = 0.0",
        "        summed = 0.0": "",
        "h * summed / mass": "h * summed / mass\n        summed -= h * force",
    },
)
mistakes(
    "MASS_LOST",
    "The mass is not used.",
    "The acceleration is force over mass: divide by the mass, as the file did.",
).edit("final_speed", {"h * summed / mass": "h * summed"})
mistakes(
    "CLEARED_ONCE",
    "Only the first step clears the sum, and the forces of the later steps still push.",
    "Set the sum to zero in every step.",
).body(
    "final_speed",
    """
        speed = summed = 0.0
        for k in range(n):
            summed += force
            speed += h * summed / mass
            if k == 0:
                summed = 0.0
        return speed
    """,
)

mistakes.accept(
    "Clears the sum at the end of the step",
    """
        def final_speed(mass, force, h, n):
            speed = summed = 0.0
            for _ in range(n):
                summed += force
                speed += h * summed / mass
                summed = 0.0
            return speed
    """,
)
mistakes.accept(
    "Needs no loop for a constant force",
    """
        def final_speed(mass, force, h, n):
            return force * h * n / mass
    """,
)


def reset_to_force(mass, force, h, n):
    return h * force / mass * (2 * n - 1)


@mistakes.more
def hypotheses():
    yield "final_speed", ("RESET_TO_THE_FORCE",), reset_to_force
    yield "final_speed", ("STEP_IGNORED",), lambda mass, force, h, n: force / mass * n
