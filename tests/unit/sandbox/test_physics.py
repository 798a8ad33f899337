"""What scenes teach is true of what they do, and a run is told in sentences."""

import math

import numpy as np
import pytest

from course.sandbox.runs.running import account, momentum, run, sentence, sentences
from course.sandbox.scene.loading import choose
from course.sandbox.world.accounts import Event, Receipt
from course.sandbox.world.world import World


def speeds(world):
    return {
        part.name: float(math.hypot(row[3], row[4]))
        for part, row in zip(world.parts, world.state(), strict=True)
    }


def test_in_newtons_cradle_the_last_ball_takes_it_all():
    world = World(choose("newtons-cradle").scene)
    world.run_until(0.56)  # a quarter period and a little
    now = speeds(world)
    came = math.sqrt(2 * 9.81 * (1 - math.cos(math.radians(30))))
    assert now["ball-5"] == pytest.approx(came, rel=0.02)
    assert max(now[f"ball-{i}"] for i in range(1, 5)) < 0.02 * came
    receipt = world.receipt
    assert receipt.contacts == pytest.approx(0, abs=1e-9)
    assert abs(receipt.residual) < 0.005 * receipt.start + abs(receipt.integrator)


@pytest.mark.parametrize("friction", [0.2, 0.8, 1.4])
def test_a_block_slips_at_the_angle_whose_tangent_is_the_product_of_frictions(friction):
    slip = math.degrees(math.atan(friction * 0.5))

    def slides(angle):
        chosen = choose("incline", {"angle": angle, "friction": friction})
        world = World(chosen.scene, chosen.settings)
        world.run_until(1.0)
        return speeds(world)["block"] > 0.01

    assert not slides(slip - 0.2)
    assert slides(slip + 0.2)


@pytest.mark.parametrize("height", [0.5, 1.0, 5.0])
def test_each_ball_of_the_row_leaves_with_its_own_restitution(height):
    chosen = choose("restitution-row", {"height": height})
    world = World(chosen.scene)
    world.run_until(1.2 * math.sqrt(2 * height / 9.81))
    first = {event.a: event for event in reversed(world.drain_events()) if event.kind == "contact"}
    assert len(first) == 6
    for i in range(6):
        event, e = first[f"ball-{i}"], i / 5
        assert event.leave == pytest.approx(e * event.approach, abs=1e-9)
        assert event.lost == pytest.approx(1 - e * e, abs=1e-9)


@pytest.mark.parametrize(
    ("step", "told", "holds"), [(1 / 240, "", False), (0.0004, "inside", False), (0.0002, "meets", True)]
)
def test_a_bullet_tunnels_unless_half_the_wall_is_thicker_than_a_jump(step, told, holds):
    chosen = choose("bullet-wall", {"step": step})
    world = World(chosen.scene, chosen.settings)
    world.run_until(0.05)
    sentences = [sentence(event) for event in world.drain_events() if not event.minor]
    assert len(sentences) == bool(told)
    assert told in "".join(sentences)
    assert (world.state()[world._space.index["bullet"], 0] < 2.2) == holds


def test_a_robot_turns_as_its_wheels_say_and_slips_beyond_its_grip():
    chosen = choose("robot-boxes", {"left": 0.3, "right": 0.3})
    world = World(chosen.scene, chosen.settings)
    world.run_until(1.0)
    x, _, angle, vx, _, _ = world.state()[world._space.index["robot"]]
    assert (angle, vx) == (pytest.approx(0, abs=1e-4), pytest.approx(0.3, rel=1e-6))
    # A standing start: grip 0.85 g for as long as it takes, so it lags by v²/2a.
    assert x + 1.0 == pytest.approx(0.3 - 0.3**2 / (2 * 0.85 * 9.81), abs=0.002)
    assert world.receipt.given > world.receipt.kinetic > 0


def test_a_box_on_a_floor_slides_as_far_as_friction_lets_it():
    world = World(choose("robot-boxes", {}).scene, {"left": 0.0, "right": 0.0})
    world.throw(0.4, -0.1, 0.0, -2.0)
    world.run_until(2.0)
    row = world.state()[world._space.index["box-1"]]
    assert -0.1 - row[1] == pytest.approx(2.0**2 / (2 * 0.4 * 9.81), abs=0.01)
    assert float(np.hypot(row[3], row[4])) == 0.0
    assert world.receipt.friction == pytest.approx(0.5 * 2 * 2.0**2, rel=1e-9)


@pytest.mark.parametrize(
    "seed", [1, pytest.param(2, marks=pytest.mark.soak), pytest.param(3, marks=pytest.mark.soak)]
)
def test_galtons_heap_is_binomial_by_chi_squared(seed):
    chosen = choose("galton-board", {"seed": seed})
    world = World(chosen.scene, receipt=False)
    world.run_until(chosen.scene.duration)
    x = [row[0] for part, row in zip(world.parts, world.state(), strict=True) if not part.fixed]
    assert len(x) == 100
    bins = np.bincount(np.clip(np.floor((np.array(x) + 0.9) / 0.2).astype(int), 0, 8), minlength=9)
    # Bins with fewer than five expected are joined, as the test demands: 0-1, 2, 3, 4, 5, 6, 7-8... of 100.
    expected = np.array([math.comb(8, k) for k in range(9)]) / 256 * 100
    groups = [[0, 1, 2], [3], [4], [5], [6, 7, 8]]
    seen, wanted = (np.array([v[g].sum() for g in groups]) for v in (bins, expected))
    chi2 = float(((seen - wanted) ** 2 / wanted).sum())
    assert chi2 < 13.28, bins  # 4 degrees of freedom: 1 run in 100 of a true binomial is above
    assert 0.9 < np.std((np.array(x) + 0.9) / 0.2) < 1.9  # sqrt(8 / 4) = 1.41


# -- in sentences ----------------------------------------------------------------------------------------


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
    base = {"start": 10.0, "given": 0.0, "kinetic": 4.0, "potential": 2.0}
    base |= {"contacts": 3.0, "friction": 1.0, "rods": 0.0}
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
