import numpy as np

from tests.checks.making import BINS, NODES, WALLS, box, seen
from timemap_cli.checks.fits import fitted
from timemap_cli.checks.surfaces import ends, offsets

STILL = np.zeros((1, 2))
ROOM = np.concatenate([WALLS, box(2.0, 1.8)])
ALL_STILL = np.zeros((len(NODES), 2))


def test_a_round_room_grown_by_five_centimetres_is_five_centimetres_off_everywhere():
    off = offsets(np.full((1, BINS), 4.05), np.full((1, BINS), 4.0), STILL)
    assert np.allclose(
        off.distance, 0.05, atol=2e-4
    )  # chords lie within the circle, by 4 m * (1 - cos 0.5 deg)
    assert np.allclose(np.hypot(off.normal_x, off.normal_y), 1)


def test_a_wall_seen_at_a_flat_angle_is_off_by_its_distance_not_by_the_range():
    bearings = (np.arange(BINS) + 0.5) * (2 * np.pi / BINS)
    with np.errstate(divide="ignore"):
        near, far = (np.where(np.sin(bearings) > 0.2, y / np.sin(bearings), np.nan) for y in (1.0, 1.05))
    off = offsets(far[None], near[None], STILL)
    inner = off.distance[0, 20:160]
    assert np.abs(far - near)[20:160].max() > 0.13
    assert np.allclose(inner[np.isfinite(inner)], 0.05, atol=1e-9)


def test_an_end_without_a_surface_near_its_bearing_is_infinitely_far_off_and_none_is_nan():
    ranges, other = np.full((1, BINS), np.nan), np.full((1, BINS), np.inf)
    ranges[0, 10] = 2.0
    other[0, 200] = 2.0
    distance = offsets(ranges, other, STILL).distance[0]
    assert distance[10] == np.inf
    assert np.isnan(distance[11])


def test_a_node_that_stands_a_little_elsewhere_sees_the_same_surfaces():
    apart = np.array([[0.1, -0.05]])
    here = seen(NODES[:1], ROOM)
    there = seen([type(NODES[0])(NODES[0].x + 0.1, NODES[0].y - 0.05)], ROOM)
    distance = offsets(here, there, apart).distance
    assert np.quantile(distance, 0.9) < 0.01


def test_the_turn_of_every_node_is_found():
    turned = seen(NODES, ROOM, turn=np.radians(1.0))
    plain = seen(NODES, ROOM)
    motion = fitted(*ends(turned), offsets(turned, plain, ALL_STILL))
    assert np.allclose(np.degrees(motion.turn), 1.0, atol=0.1)
    assert np.allclose([motion.x, motion.y], 0, atol=0.003)


def test_the_shift_of_every_node_is_found_in_the_map_frame():
    shifted = seen(NODES, ROOM, shift=(0.03, -0.02))
    motion = fitted(*ends(shifted), offsets(shifted, seen(NODES, ROOM), ALL_STILL))
    assert np.allclose(motion.x, 0.03, atol=0.003)
    assert np.allclose(motion.y, -0.02, atol=0.003)
    assert np.allclose(np.degrees(motion.turn), 0.0, atol=0.1)


def test_a_thing_that_moved_does_not_move_the_node():
    moved = seen(NODES, np.concatenate([WALLS, box(2.15, 1.8)]))
    motion = fitted(*ends(moved), offsets(moved, seen(NODES, ROOM), ALL_STILL))
    assert np.abs([motion.x, motion.y]).max() < 0.01


def test_a_node_that_sees_hardly_anything_tells_no_motion():
    ranges = np.full((1, BINS), np.nan)
    ranges[0, :19] = 2.0
    motion = fitted(*ends(ranges), offsets(ranges, ranges, STILL))
    assert not motion.known.any()
