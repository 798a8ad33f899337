"""Finding out which mistake ``lidar`` of ``digital-twin`` makes: scenes of one wall or two, and a room."""

from __future__ import annotations

import math

import numpy as np

from course.scoring import kit

bundles = kit.companion("digital-twin", "bundles")
draws = kit.companion("digital-twin", "sensor_probes")
named = draws.named

_WALL = np.array([[[2.0, -1.0], [2.0, 1.0]]])
_ROW = np.array([[[2.0, -1.0], [2.0, 1.0]], [[1.0, -1.0], [1.0, 1.0]], [[3.5, -1.0], [3.5, 1.0]]])
_LONG = np.array([[[1.0, 0.5], [3.0, 0.5]]])  # parallel to a beam along x
_BEFORE = np.array([[[1.0, -0.5], [1.0, 9.0]], *_WALL])  # a near wall whose middle is farther off
_WIDE = np.array([[[2.0, -8.0], [2.0, 8.0]]])  # both ends beyond the reach, and next its middle
_ASIDE = np.array([[[2.0, -0.5], [2.0, 14.0]]])
_ORIGIN, _REACH = (0.0, 0.0, 0.0), 5.0
_ONE_METRE = np.array([[[2.0, -0.5], [2.0, 0.5]]])
_FALLING = np.array([[[2.0, 1.5], [3.0, -2.0]]])  # and, its ends' x and y each in order, rising
_TWICE = np.concatenate((_WALL, _WALL))

#: Four beams in a crooked room, and how far off its walls are along each.
_CORNERS = np.array([[-2.0, -1.5], [3.0, -1.0], [2.5, 2.0], [-1.5, 1.2]])
_ROOM = np.stack((_CORNERS, np.roll(_CORNERS, -1, axis=0)), axis=1)
_X, _Y, _HEADING = 0.4, 0.3, 0.7
_FAN = np.array([-2.9, -0.8, 0.5, 2.1])
_READS = (2.080981412770427, 2.4360363400828278, 1.4891209215957006, 2.0579057845480433)


def _at(beam, *distances):
    """What a beam reads of walls across the x axis."""
    return tuple(x / math.cos(beam) for x in distances)


def _cut(beam, walls):
    """How far off, along a beam from the origin, the line of the first of these walls is."""
    (ax, ay), (bx, by) = walls[0]
    return (ax * (by - ay) - ay * (bx - ax)) / (math.cos(beam) * (by - ay) - math.sin(beam) * (bx - ax))


#: code, position, walls, the one beam, the right reading, readings that only this mistake gives
_SCENES = (
    ("POSITION_IGNORED", (0.5, 0.1, 0.0), _WALL, 0.0, 1.5, (2.0,)),
    ("WALLS_BEHIND_SEEN", _ORIGIN, _WALL, 3.0, _REACH, (0.0, *_at(3.0, 2.0, -2.0))),
    ("WALLS_ENDLESS", _ORIGIN, _WALL, 1.0, _REACH, _at(1.0, 2.0)),
    ("WALLS_ENDLESS", _ORIGIN, _WALL, -1.0, _REACH, _at(1.0, 2.0)),
    # One of 2 m seems to go on for as much again, and one of half a metre to be half as long.
    ("WALL_SHARE_IN_METRES", _ORIGIN, _WALL, 0.8, _REACH, _at(0.8, 2.0)),
    ("WALL_SHARE_IN_METRES", _ORIGIN, _WALL * (1.0, 0.25), 0.05, *_at(0.05, 2.0), (_REACH,)),
    ("NOT_THE_NEAREST", _ORIGIN, _ROW, 0.1, *_at(0.1, 1.0), _at(0.1, 2.0, 3.5)),
    ("NOT_THE_NEAREST", _ORIGIN, _BEFORE, 0.1, *_at(0.1, 1.0), _at(0.1, 2.0)),
    ("BEYOND_RANGE", _ORIGIN, _WALL + np.array([4.0, 0.0]), 0.01, _REACH, _at(0.01, 6.0)),
    ("LONG_WALL_LEFT_OUT", _ORIGIN, _WIDE, 0.1, *_at(0.1, 2.0), (_REACH,)),
    ("LONG_WALL_LEFT_OUT", _ORIGIN, _ASIDE, 0.1, *_at(0.1, 2.0), (_REACH,)),
    ("PARALLEL_TEST_WRONG", _ORIGIN, _ONE_METRE, 0.0, 2.0, (_REACH,)),
    ("PARALLEL_TEST_WRONG", _ORIGIN, _ONE_METRE[:, ::-1], 0.0, 2.0, (_REACH,)),
    ("PARALLEL_TEST_WRONG", _ORIGIN, _ONE_METRE * (1.0, 0.2), 0.0, 2.0, (_REACH,)),
    ("WALL_ENDS_SORTED", _ORIGIN, _FALLING, 0.05, _cut(0.05, _FALLING), (_cut(0.05, np.sort(_FALLING, 1)),)),
    ("WALL_AT_PI_MISSED", _ORIGIN, -_WALL, 3.0, *_at(3.0, -2.0), (_REACH,)),
    ("NEAR_WALL_NOT_SEEN", (1.995, 0.0, 0.0), _WALL, 0.0, 0.005, (_REACH,)),
)
#: position, walls, the one beam, the right reading: a wall ahead whose ends come in one order and in the
#: other, one wall along the beam, none within reach
_PLAIN = (
    (_ORIGIN, _WALL[:, ::-1], 0.3, *_at(0.3, 2.0)),
    (_ORIGIN, _WALL, 0.3, *_at(0.3, 2.0)),
    (_ORIGIN, np.concatenate((_LONG, _WALL)), 0.0, 2.0),
    (_ORIGIN, _WALL + np.array([40.0, 0.0]), 2.0, _REACH),
)


#: A wall in three places; what a beam at it reads has to differ.
_SHIFTS = ((0.0, 0.0), (1.0, 0.3), (-0.7, -0.2))
_SLANTED = np.array([[[2.0, -1.5], [3.0, 2.0]]])
_BEAM = 0.05
#: One along the x axis to the left, and the slanted one, both turned there; the beam at them.
_LEFT = [np.stack((-walls[..., 1], walls[..., 0]), axis=-1) for walls in (_WALL, _SLANTED)]
_LEFT_BEAM = math.pi / 2 + _BEAM


@np.errstate(all="ignore")  # a submission may have returned anything
def of_lidar(submission, noisy=True, straight=False):
    """The mistake that ``lidar`` makes, from a room and from scenes with one wall or two, without noise.

    A mistake is named where the readings are those that it gives, not only where they are wrong.
    noisy: whether the noise may have to do with it
    straight: whether the robot looks along the x axis, so that its heading has nothing to do with it
    """
    scenes = [scene[1:5] for scene in _SCENES] + list(_PLAIN)
    beams = ((_HEADING, _FAN), (0.0, _FAN), (0.0, _FAN - _HEADING), (0.0, _FAN + _HEADING))
    calls = [((_X, _Y, heading), _ROOM, fan) for heading, fan in beams]
    calls += [((-0.5, 0.6, _HEADING), _ROOM, _FAN)]
    calls += [(pose, walls, np.array([beam])) for pose, walls, beam, _ in scenes]
    calls += [(_ORIGIN, wall + shift, np.array([_BEAM])) for wall in (_WALL, _SLANTED) for shift in _SHIFTS]
    calls += [(_ORIGIN, wall, np.array([_LEFT_BEAM])) for wall in _LEFT]
    calls = [(*call, _REACH, 0.0, np.random.default_rng(1)) for call in calls]
    results = submission.call_each("lidar", calls)
    *fans, moved = (kit.as_vector(result, len(_FAN), "ranges") for result in results[: len(beams) + 1])
    readings = np.array([kit.as_vector(result, 1, "ranges")[0] for result in results[len(beams) + 1 : -8]])
    *shifted, level, left = (float(kit.as_vector(result, 1, "ranges")[0]) for result in results[-8:])
    if len(set(shifted)) == 1 and shifted[0] != _REACH:
        return named("WALLS_NOT_READ")
    if _along_axes_missed(shifted, level, left):
        return named("WALLS_ALONG_AXES_MISSED")
    if _missed_by_rounding(submission):
        return named("WALLS_MISSED_BY_ROUNDING")
    right = np.abs(readings - [scene[-1] for scene in scenes]) < 1e-9
    if np.all(right) and (straight or np.allclose(fans[0], _READS, rtol=0, atol=1e-9)):
        return of_lidar_noise(submission) if noisy else None
    fixed = np.allclose(moved, fans[0], rtol=0, atol=1e-9)
    seen = np.abs(fans[3 if straight else 0] - _READS) < 1e-9
    return _of_scenes(readings, right, None if straight else _turning(*fans), fixed, seen)


def _missed_by_rounding(submission):
    """Whether some beams pass through a wall along y, and none of them through the same wall turned."""
    fan, turn = np.linspace(-0.9, 0.9, 41), 0.3
    wall = np.array([[2.0, -3.0], [2.0, 3.0]])
    away = np.array([[math.cos(turn), math.sin(turn)], [-math.sin(turn), math.cos(turn)]])
    calls = [
        ((0.0, 0.0, heading), walls[None], fan, _REACH, 0.0, np.random.default_rng(1))
        for heading, walls in ((0.0, wall), (turn, wall @ away))
    ]
    level, turned = (kit.as_vector(one, len(fan), "ranges") for one in submission.call_each("lidar", calls))
    return 0 < np.count_nonzero(level == _REACH) < len(fan) and not np.any(turned == _REACH)


def _along_axes_missed(shifted, level, left):
    """Whether walls along x or y are not seen, and slanted ones in the same places are as they are.

    shifted: what is read of the wall along y in three places, then of the slanted one; level, left: of those
        to the left
    """
    (ax, ay), (wx, wy) = (_SLANTED[0, 0] + _SHIFTS).T, _SLANTED[0, 1] - _SLANTED[0, 0]
    slanted = (ax * wy - ay * wx) / (math.cos(_BEAM) * wy - math.sin(_BEAM) * wx)
    if not np.allclose([*shifted[3:], left], [*slanted, slanted[0]], rtol=0, atol=1e-9):
        return False
    return all(reading == _REACH for reading in shifted[:3]) or level == _REACH


def of_straight_lidar(submission, noisy=True):
    """The same for a robot whose heading is 0: beams that do not turn with it are no reason."""
    # The heading minus the angle is wrong at a heading of 0 as well, but where noise is on, left is as right.
    mirrored = not noisy and kit.attempt(lambda: _mirrored(submission))
    refuted = {"HEADING_IGNORED"} if mirrored else _OF_HEADING
    return bundles.unless(
        refuted,
        lambda: of_lidar(submission, noisy),
        lambda: of_lidar(submission, noisy, straight=True),
    )


_OF_HEADING = {"HEADING_IGNORED", "HEADING_SUBTRACTED"}


def _mirrored(submission):
    """Whether a beam to the left sees what lies to the right, at a heading of 0."""
    aside = np.array([[[-20.0, 1.0], [20.0, 1.0]]])
    call = _ORIGIN, aside, np.array([0.5, -0.5]), _REACH, 0.0, np.random.default_rng(1)
    left, right = kit.as_vector(submission.call("lidar", *call), 2, "ranges")
    return left == _REACH and abs(right - 1.0 / math.sin(0.5)) < 1e-9


def _turning(turned, ahead, less, more):
    """What turning the robot does to its beams, if not to turn them along; fans as they were asked for."""
    if np.ptp(ahead) < 0.1 or np.allclose(turned, more, rtol=0, atol=1e-9):
        return None
    if np.allclose(turned, ahead, rtol=0, atol=1e-9):
        return "HEADING_IGNORED"
    return "HEADING_SUBTRACTED" if np.allclose(turned, less, rtol=0, atol=1e-9) else None


def _of_scenes(readings, right, turning, fixed, seen):
    """From what was read in the scenes, and what turning the robot does to the beams of the room.

    fixed: whether moving it changes nothing there
    seen: which beams read the room as it is; all do from within although walls have no ends, or parallel ones
        are seen
    """
    room = bool(np.all(seen))
    turned, plain, parallel, nothing = right[-4:]
    if not nothing:
        return named("NO_HIT_NOT_MAX")
    if turned != plain and readings[-3 if turned else -4] == _REACH:
        return named("WALLS_ONE_SIDED")
    if not plain:
        return None  # beams go astray, and not in a way that is known: nothing else can be told from them
    if turning:
        return named(turning)
    if np.all(right[:-4]) and not parallel and room:
        return named("PARALLEL_WALLS")
    read = zip(_SCENES, readings, strict=False)
    codes = [code for (code, *_, slips), r in read if np.min(np.abs(np.subtract(slips, r))) < 1e-9]
    # From within a convex room a beam meets one wall: there it is the nearest.
    only = {"POSITION_IGNORED": fixed, "WALLS_ENDLESS": room, "NOT_THE_NEAREST": room}
    only["WALL_AT_PI_MISSED"] = seen[0]  # the first beam looks behind, at a wall that is not across -x
    only["WALL_SHARE_IN_METRES"] = codes.count("WALL_SHARE_IN_METRES") == 2
    return next((named(code) for code in codes if only.get(code, True)), None)


@np.errstate(all="ignore")  # a submission may have returned anything
def of_lidar_noise(submission):
    """The mistake in the noise of ``lidar``, from two fans of beams on one wall and one fan on none."""
    fan = np.linspace(-0.4, 0.4, 2000)
    near, none = (1.95, 0.0, 0.0), (-20.0, 0.0, 0.0)
    ahead = np.linspace(-0.01, 0.01, 2000)
    places = ((_ORIGIN, fan), (none, fan), (near, fan), ((-2.95, 0.0, 0.0), ahead))
    calls = [
        (pose, _WALL, beams, 5.0, sigma, np.random.default_rng(seed))
        for sigma in (0.1, 0.0)
        for seed, (pose, beams) in enumerate(places)
    ]
    calls.append((_ORIGIN, _TWICE, fan, 5.0, 0.1, np.random.default_rng(4)))
    *scans, twice = (kit.as_vector(r, 2000, "ranges") for r in submission.call_each("lidar", calls))
    hits, misses, close, far, *quiet = scans
    exact = 2.0 / np.cos(fan), 5.0, 0.05 / np.cos(fan), 4.95 / np.cos(ahead)
    if not all(np.allclose(*pair, rtol=0, atol=1e-9) for pair in zip(quiet, exact, strict=True)):
        return None  # a wall is not seen as it is without noise: what is read of it tells nothing of noise
    noise = hits - exact[0]
    spread = float(np.std(noise))
    looks = (
        ("LIDAR_NOISE_ON_MAX", not np.all(misses == 5.0)),
        ("LIDAR_NOISE_SHARED", spread < 1e-9 < abs(noise[0])),
        ("LIDAR_NOISE_MISSING", spread < 1e-9),
        ("NEGATIVE_RANGE", np.any(close < 0)),
        ("LIDAR_SIGMA_WRONG", not 0.09 < spread < 0.11),
        ("NOISE_CUT_AT_MAX", not np.any(far > 5.0)),  # the wall is 4.95 m away
        ("NOISE_BEFORE_NEAREST", abs(np.mean(noise)) < 0.012 and _is_smaller_of_two(twice - exact[0])),
    )
    code = next((code for code, seen in looks if seen), None)
    return named(code) if code else of_scan_draws(submission)


def _is_smaller_of_two(noise):
    """Whether noise (2000,) is that of the smaller of two readings of std 0.1, by mean and std."""
    mean, spread = -0.1 / math.sqrt(math.pi), 0.1 * math.sqrt(1 - 1 / math.pi)
    return abs(np.mean(noise) - mean) < 0.012 and abs(np.std(noise) - spread) < 0.008


@np.errstate(all="ignore")  # a submission may have returned anything
def of_scan_draws(submission):
    """Whether the noise of ``lidar`` comes from the generator that is passed in."""
    calls = [(_ORIGIN, _WALL, _AHEAD, 5.0, 0.1, np.random.default_rng(seed)) for seed in draws.SEEDS]
    return draws.of_draws([kit.as_vector(r, 8, "ranges") for r in submission.call_each("lidar", calls)])


_AHEAD = np.linspace(-0.4, 0.4, 8)
