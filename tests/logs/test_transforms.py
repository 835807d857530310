import numpy as np
import pytest

from tests.logs.making import SECOND, ns, tf, yaw
from timemap_cli.logs.history import MAX_SAMPLES
from timemap_cli.logs.transforms import TransformBuffer

UPSIDE_DOWN = np.array([[1.0, 0, 0, 0]])


def buffer(*batches):
    held = TransformBuffer()
    for batch in batches:
        held.add(batch)
    return held


def known(held, target, source, seconds):
    return held.lookup(target, source, ns(seconds))[1].tolist()


def position(held, target, source, seconds):
    transform, valid = held.lookup(target, source, ns(seconds))
    assert valid.all()
    return transform[..., 3]


def heading(transform):
    return np.degrees(np.arctan2(transform[:, 1, 0], transform[:, 0, 0]))


def test_lookup_between_samples_interpolates_place_and_turn():
    held = buffer(tf("map", "base", [1, 2], [[0, 0, 0], [4, 2, 0]], yaw([0, 90])))
    transform, valid = held.lookup("map", "base", ns([1.25]))
    assert valid.all()
    np.testing.assert_allclose(transform[0, :, 3], (1, 0.5, 0))
    np.testing.assert_allclose(heading(transform), [22.5])


def test_turn_goes_the_short_way_through_180_degrees():
    held = buffer(tf("map", "base", [1, 2], [[0, 0, 0]], yaw([170, -170])))
    np.testing.assert_allclose(np.abs(heading(held.lookup("map", "base", ns(1.5))[0])), [180])


def test_nothing_is_extrapolated():
    held = buffer(tf("map", "base", [1, 2], [[0, 0, 0], [1, 0, 0]]))
    assert known(held, "map", "base", [0.999999999, 1, 1.5, 2, 2.000000001]) == [
        False,
        True,
        True,
        True,
        False,
    ]
    assert np.isnan(held.lookup("map", "base", ns(3))[0]).all()


def test_a_single_sample_holds_at_its_own_stamp_only():
    held = buffer(tf("map", "base", [1], [[5, 0, 0]]))
    assert known(held, "map", "base", [0.5, 1, 1.5]) == [False, True, False]


def test_static_edges_hold_at_all_times():
    held = buffer(tf("base", "laser", [1e6], [[0.2, 0, 0]], static=True))
    np.testing.assert_allclose(position(held, "base", "laser", [-5, 0, 1e9]), [[0.2, 0, 0]] * 3)


def test_chain_with_static_mount_behind_a_moving_base():
    held = buffer(
        tf("map", "odom", [0, 10], [[10, 0, 0]], yaw(90)),
        tf("odom", "base", [0, 10], [[0, 0, 0], [10, 0, 0]]),
        tf("base", "laser", [0], [[0.5, 0, 0.3]], UPSIDE_DOWN, static=True),
    )
    transform, valid = held.lookup("map", "laser", ns([3]))
    assert valid.all()
    # map looks along y: 3 m driven and the laser 0.5 m ahead; the laser's left is the robot's right, +x in the map
    np.testing.assert_allclose(transform[0, :, 3], (10, 3.5, 0.3), atol=1e-12)
    np.testing.assert_allclose(transform[0, :, 1], (1, 0, 0), atol=1e-12)


def test_edges_recorded_the_other_way_round_are_followed():
    # fiducial localisation: the camera's pose is the inverse of what is published (base -> map)
    held = buffer(
        tf("base", "map", [0, 1], [[-2, 0, 0]], yaw(-90)),
        tf("base", "laser", [0], [[1, 0, 0]], static=True),
    )
    transform, _ = held.lookup("map", "laser", ns([0.5]))
    # inverse by hand: the base stands at R(90) * (2, 0) = (0, 2), looking along y; the laser 1 m ahead
    np.testing.assert_allclose(transform[0, :, 3], (0, 3, 0), atol=1e-12)
    np.testing.assert_allclose(heading(transform), [90])


def test_siblings_meet_at_their_common_parent_whatever_lies_above():
    held = buffer(
        tf("base", "laser", [0], [[1, 0, 0]], static=True),
        tf("base", "footprint", [0], [[0, 0, -0.1]], static=True),
        tf("odom", "base", [100], [[7, 7, 7]]),
    )
    np.testing.assert_allclose(position(held, "footprint", "laser", [5]), [[1, 0, 0.1]])


def test_frames_that_are_not_connected_have_no_transform():
    held = buffer(tf("odom", "base", [0, 1], [[0, 0, 0]]), tf("map", "other", [0, 1], [[0, 0, 0]]))
    assert known(held, "map", "base", [0.5]) == [False]
    assert known(held, "nowhere", "base", [0.5]) == [False]
    assert known(held, "base", "base", [77]) == [True]


def test_a_loop_of_frames_ends():
    held = buffer(tf("a", "b", [0, 1], [[0, 0, 0]]), tf("b", "a", [0, 1], [[0, 0, 0]]))
    assert known(held, "map", "a", [0.5]) == [False]
    assert held.ancestors("a") == ("a", "b")


def test_no_interpolation_across_a_gap_of_more_than_10_s():
    held = buffer(tf("map", "base", [0, 10, 20.000000001], [[0, 0, 0], [10, 0, 0], [0, 0, 0]]))
    assert known(held, "map", "base", [5, 10, 15, 20.000000001]) == [True, True, False, True]


def test_of_equal_stamps_the_last_received_counts():
    held = buffer(tf("map", "base", [1, 2, 2], [[0, 0, 0], [1, 0, 0], [2, 0, 0]]))
    held.add(tf("map", "base", [1], [[8, 0, 0]]))
    np.testing.assert_allclose(position(held, "map", "base", [1, 1.5, 2])[:, 0], (8, 5, 2))


def test_samples_that_arrive_out_of_order_are_sorted_in():
    held = buffer(tf("map", "base", [0, 2], [[0, 0, 0], [2, 0, 0]]))
    np.testing.assert_allclose(position(held, "map", "base", [1])[:, 0], [1])
    held.add(tf("map", "base", [1.5, 1], [[9, 0, 0], [5, 0, 0]]))
    np.testing.assert_allclose(position(held, "map", "base", [1, 1.25, 1.5])[:, 0], (5, 7, 9))


def test_a_frame_may_change_its_parent_and_the_older_one_holds_in_between():
    held = buffer(
        tf("map", "lift", [0], [[100, 0, 0]], static=True),
        tf("map", "base", [0, 1], [[0, 0, 0], [1, 0, 0]]),
        tf("lift", "base", [2, 3], [[5, 0, 0], [6, 0, 0]]),
    )
    np.testing.assert_allclose(position(held, "map", "base", [0.5, 1.5, 2, 2.5])[:, 0], (0.5, 1, 105, 105.5))


def test_a_static_edge_replaces_an_older_one():
    held = buffer(*(tf("base", "laser", [x], [[x, 0, 0]], static=True) for x in (9, 1, 2)))
    np.testing.assert_allclose(position(held, "base", "laser", [5])[:, 0], [2])


def test_a_moving_edge_takes_the_place_of_a_static_one_when_it_begins():
    # a placeholder map -> odom until localisation starts
    held = buffer(
        tf("map", "odom", [0], [[0, 0, 0]], static=True), tf("map", "odom", [5, 8], [[7, 0, 0], [8, 0, 0]])
    )
    held.forget(int(7 * SECOND))
    held.add(tf("map", "odom", [9], [[9, 0, 0]]))
    found, valid = held.lookup("map", "odom", ns([4.9, 8.5, 9.1]))
    assert valid.tolist() == [True, True, False]
    np.testing.assert_allclose(found[:2, 0, 3], (0, 8.5))


@pytest.mark.parametrize(
    ("xyz", "rotation"),
    [
        ([[0, 0, 0]], [[0, 0, 0, 0]]),
        ([[0, 0, 0]], [[np.nan, 0, 0, 1]]),
        ([[0, np.nan, 0]], [[0, 0, 0, 1]]),
        ([[np.inf, 0, 0]], [[0, 0, 0, 1]]),
        ([[0, 0, 0]], [[0, 0, 0, np.inf]]),
    ],
)
def test_what_is_no_transform_is_dropped_and_counted(xyz, rotation):
    held = buffer(tf("map", "base", [1], xyz, rotation), tf("map", "base", [0, 2], [[0, 0, 0], [2, 0, 0]]))
    assert held.rejected == 1
    np.testing.assert_allclose(position(held, "map", "base", [1])[:, 0], [1])


def test_a_frame_that_is_its_own_parent_or_has_no_name_is_dropped_and_counted():
    held = buffer(*(tf(parent, child, [1, 2], [[0, 0, 0]]) for parent, child in ("aa", ("", "a"), ("a", ""))))
    assert (held.rejected, len(held)) == (6, 0)


def test_unnormalised_quaternions_are_normalised():
    held = buffer(tf("map", "base", [0, 1], [[0, 0, 0]], 3 * yaw([0, 90])))
    transform, _ = held.lookup("map", "base", ns([0.5]))
    np.testing.assert_allclose(heading(transform), [45])
    np.testing.assert_allclose(np.linalg.det(transform[0, :, :3]), 1)


def test_forgetting_keeps_the_last_sample_before():
    held = buffer(tf("map", "base", np.arange(10), np.arange(30).reshape(10, 3)))
    before = held.lookup("map", "base", ns([5.5, 7]))[0]
    held.forget(int(5.5 * SECOND))
    assert len(held) == 5
    np.testing.assert_array_equal(held.lookup("map", "base", ns([5.5, 7]))[0], before)
    assert known(held, "map", "base", [4.9]) == [False]


def test_forgetting_all_but_the_newest_goes_edge_by_edge():
    held = buffer(
        tf("map", "base", np.arange(10), [[0, 0, 0]]), tf("base", "x", 100 + np.arange(10), [[0, 0, 0]])
    )
    held.forget_all_but(3 * SECOND)
    assert len(held) == 2 * 5


def test_memory_is_bounded_even_where_stamps_never_fall_behind():
    held = TransformBuffer()
    for start in range(0, 3 * MAX_SAMPLES, 10_000):
        held.add(tf("map", "base", np.arange(start, start + 10_000), [[0, 0, 0]]))
        held.forget(0)
        assert len(held) <= MAX_SAMPLES + 10_000


def test_lookups_agree_with_a_plain_reading_of_tf2_one_stamp_at_a_time():
    generator = np.random.default_rng(5)
    tree = [
        ("map", "odom"),
        ("odom", "base"),
        ("base", "arm"),
        ("arm", "laser"),
        ("base", "wheel"),
        ("dock", "base"),
    ]
    samples, held = {}, TransformBuffer()
    for parent, child in tree:
        n = 40
        stamps = np.sort(generator.integers(0, 60, n)) + generator.integers(0, 3, n) * 0.25
        if parent == "dock":
            stamps = generator.uniform(25, 30, n)
        xyz, q = generator.normal(size=(n, 3)), generator.normal(size=(n, 4))
        held.add(tf(parent, child, stamps, xyz, q))
        for row in range(n):
            samples.setdefault(child, {})[int(ns(stamps[row])[0])] = (
                parent,
                xyz[row],
                q[row] / np.linalg.norm(q[row]),
            )
    held.add(tf("map", "dock", [0], [[1, 2, 3]], yaw(30), static=True))
    static = {"dock": ("map", np.array([1.0, 2, 3]), yaw(30)[0])}
    stamps = np.concatenate([generator.uniform(-1, 61, 300), np.arange(60)])
    for target, source in (
        ("map", "laser"),
        ("laser", "map"),
        ("wheel", "laser"),
        ("dock", "laser"),
        ("odom", "wheel"),
    ):
        found, valid = held.lookup(target, source, ns(stamps))
        assert 30 < valid.sum() < len(stamps)
        for row, stamp in enumerate(ns(stamps).tolist()):
            expected = plain_lookup(samples, static, target, source, stamp)
            assert valid[row] == (expected is not None)
            if expected is not None:
                np.testing.assert_allclose(found[row, :, 3], expected[0], atol=1e-9)
                np.testing.assert_allclose(
                    found[row, :, 0], turned(expected[1], np.array([1.0, 0, 0])), atol=1e-9
                )
                np.testing.assert_allclose(
                    found[row, :, 1], turned(expected[1], np.array([0, 1.0, 0])), atol=1e-9
                )


def plain_lookup(samples, static, target, source, stamp):
    """tf2's walk: both frames up to the top, then one against the other; poses as (translation, quaternion)."""

    def to_top(frame):
        pose = np.zeros(3), np.array([0, 0, 0, 1.0])
        while (edge := plain_edge(samples, static, frame, stamp)) is not None:
            frame, above = edge[0], edge[1:]
            pose = above[0] + turned(above[1], pose[0]), multiplied(above[1], pose[1])
        return frame, pose

    (top_s, source_pose), (top_t, target_pose) = to_top(source), to_top(target)
    if top_s != top_t:
        return None
    back = target_pose[1] * (-1, -1, -1, 1)
    return turned(back, source_pose[0] - target_pose[0]), multiplied(back, source_pose[1])


def plain_edge(samples, static, frame, stamp):
    if frame in static:
        return static[frame]
    times = sorted(samples.get(frame, ()))
    older = [time for time in times if time <= stamp]
    newer = [time for time in times if time > stamp]
    if not older or (older[-1] != stamp and (not newer or newer[0] - older[-1] > 10 * SECOND)):
        return None
    parent, xyz, q = samples[frame][older[-1]]
    if older[-1] == stamp or samples[frame][newer[0]][0] != parent:
        return parent, xyz, q
    share = (stamp - older[-1]) / (newer[0] - older[-1])
    _, xyz2, q2 = samples[frame][newer[0]]
    q2 = -q2 if q @ q2 < 0 else q2
    angle = np.arccos(min(1.0, q @ q2))
    between = (np.sin((1 - share) * angle) * q + np.sin(share * angle) * q2) / np.sin(angle)
    return parent, (1 - share) * xyz + share * xyz2, between


def multiplied(p, q):
    x, y, z, w = p
    a, b, c, d = q
    return np.array(
        [
            w * a + x * d + y * c - z * b,
            w * b - x * c + y * d + z * a,
            w * c + x * b - y * a + z * d,
            w * d - x * a - y * b - z * c,
        ]
    )


def turned(q, v):
    return multiplied(multiplied(q, np.append(v, 0.0)), q * (-1, -1, -1, 1))[:3]


def test_a_place_that_is_not_on_earth_is_rejected():
    utm_with_zone = [32_500_000.0, 5_800_000.0, 100.0]
    held = buffer(tf("map", "base", [1, 2, 3], [utm_with_zone, [1e9, 0, 0], utm_with_zone]))
    assert held.rejected == 1
    np.testing.assert_allclose(position(held, "map", "base", [2]), [utm_with_zone])


def test_there_are_never_more_frames_than_the_bound_and_those_beyond_are_counted(monkeypatch):
    monkeypatch.setattr("timemap_cli.logs.transforms.MOST_FRAMES", 2)
    buffer = TransformBuffer()
    buffer.add(tf("map", "laser", [0, 1], [1, 0, 0]))
    buffer.add(tf("map", "camera", [0], [1, 0, 0], static=True))
    buffer.add(tf("map", "third", [0, 1], [1, 0, 0]))
    buffer.add(tf("map", "laser", [2], [2, 0, 0]))
    assert (len(buffer), buffer.rejected) == (4, 2)
    known = buffer.lookup("map", "laser", ns([2]))[1], buffer.lookup("map", "third", ns([0]))[1]
    assert [bool(one[0]) for one in known] == [True, False]
