"""A run in sentences."""

from course.sandbox.runs.running import account, momentum, run, sentence, sentences
from course.sandbox.scene.loading import choose
from course.sandbox.world.accounts import Event, Receipt
from course.sandbox.world.world import World


def contact(**more):
    given = {"kind": "contact", "t": 0.42, "step": 101, "a": "ball", "b": "floor", "approach": 4.09}
    return Event(**{**given, "leave": 3.27, "before": 8.36, "after": 5.35, **more})


def test_a_contact_tells_speeds_and_the_share_of_energy_that_is_gone():
    assert sentence(contact()) == (
        "0.42 s: the ball meets the floor at 4.09 m/s and leaves at 3.27; 36 % of its kinetic energy is gone."
    )
    assert "their kinetic energy" in sentence(contact(b="ball-2", shared=True))
    assert "ball 2" in sentence(contact(b="ball-2"))
    assert "stays with it; all of its kinetic energy" in sentence(contact(leave=0.0, after=0.0))
    assert "leaves at 0.05; nearly all of its kinetic" in sentence(contact(leave=0.05, after=0.01))
    assert sentence(contact(leave=None, before=None, after=None)).endswith("at 4.09 m/s.")
    assert "found inside" in sentence(contact(approach=-100.0))


def test_of_two_bodies_that_can_move_neither_is_said_to_leave():
    assert "the ball and the floor meet at 4.09 m/s and part at 3.27;" in sentence(contact(shared=True))
    assert "meet at 4.09 m/s and stay together;" in sentence(contact(shared=True, leave=0.0))


def test_soft_touches_and_chatter_are_counted_and_not_told():
    # What is soft hides nothing: the last ball of a chain is touched just before it is hit.
    events = [contact(), contact(t=0.43), contact(t=0.89, approach=0.01, minor=True), contact(t=0.9)]
    told = list(sentences(events))
    assert len(told) == 3
    assert told[-1].startswith("1 more event happened")


def test_a_long_run_is_cut_and_says_so():
    told = list(sentences((contact(t=i) for i in range(100)), most=10))
    assert len(told) == 11
    assert told[-1].startswith("90 more events")


def test_the_account_names_what_the_solver_did():
    base = {
        "start": 10.0,
        "given": 0.0,
        "kinetic": 4.0,
        "potential": 2.0,
        "contacts": 3.0,
        "friction": 1.0,
        "rods": 0.0,
    }
    assert "unaccounted" in account(Receipt(**base, residual=0.0, integrator=0.0))[-1]
    lost = account(Receipt(**{**base, "kinetic": 3.5}, residual=0.5, integrator=0.0))[-1]
    assert "missing" in lost
    made = account(Receipt(**{**base, "kinetic": 4.5}, residual=-0.5, integrator=0.0))[-1]
    assert "has no physical source" in made
    assert "5 %" in made
    caught = account(Receipt(**{**base, "kinetic": 3.5, "rods": 0.5}, residual=0.0, integrator=0.0))
    assert "lost in rods 0.5" in caught[1]


def test_what_hands_do_names_bodies_as_sentences_do():
    world = World(choose("head-on").scene)
    world.copy("left-puck")
    world.aim("left-puck", 1.0, 0.0)
    told = [sentence(event) for event in world.drain_events()]
    assert told == [
        "0.00 s: new 1 appears, like the left puck.",
        "0.00 s: the left puck now moves at 1.00 m/s.",
    ]


def test_momentum_is_kept_only_where_it_never_changed():
    assert momentum(run(choose("head-on"))) == ["Momentum is kept: (1, 0) kg m/s."]
    assert "changed in between" in momentum(run(choose("free-fall"), duration=80.0))[0]  # long ago
    still = choose("restitution-row", {"restitution": 0.1})
    assert "ends as it began, (0, 0) kg m/s, and changed in between" in momentum(run(still, duration=5.0))[0]


def test_a_body_that_left_took_its_energy_out_and_a_whole_is_100_percent():
    first, _, last = account(run(choose("free-fall"), duration=60.0).receipt)
    assert "taken out since 2.772 J" in first
    assert last.endswith("(100 %).")
