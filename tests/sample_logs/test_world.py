"""What the simulated laser sees of walls, things that come and go, glass and people."""

import numpy as np
import pytest

from sample_logs.laser import Mount, Scanner
from sample_logs.robot import Motion
from sample_logs.world import Thing, Walk, World, box, disc, outline_segments, wall

AHEAD = Mount(0.0, 0.0, 0.0, 0.0)


def scanner(**given):
    settings = {
        "first_deg": -90.0,
        "step_deg": 1.0,
        "beams": 181,
        "period": 0.1,
        "sweep_time": 0.0,
        "range_min": 0.1,
        "range_max": 10.0,
        "mount": AHEAD,
    }
    return Scanner(**(settings | given))


def standing(x=0.0, y=0.0, yaw=0.0):
    return Motion(np.array([0.0, 100.0]), np.array([[x, y, yaw]] * 2))


def look(world, starts, beam=90, **given):
    """True distance of one beam of sweeps from the origin."""
    laser = scanner(**given)
    origins, bearings = laser.rays(standing().at(np.array(starts)[:, None] + np.zeros(laser.beams)))
    return world.ranges(np.array(starts), origins, bearings, laser.range_max)[:, beam]


def rng():
    return np.random.Generator(np.random.PCG64(3))


def test_a_box_turned_by_a_quarter_swaps_its_sides():
    turned = Thing("box", box(1.0, 2.0, 4.0, 2.0, 90.0))
    assert turned.bounds == pytest.approx((0.0, 0.0, 2.0, 4.0))


def test_a_disc_has_its_corners_on_the_circle_around_its_centre():
    corners = disc(1.0, 2.0, 0.5)
    np.testing.assert_allclose(np.hypot(*(corners - (1.0, 2.0)).T), 0.5)
    np.testing.assert_allclose(corners.mean(axis=0), [1.0, 2.0])


def test_an_outline_is_closed():
    edges = outline_segments(box(0, 0, 2, 2))
    np.testing.assert_array_equal(edges[:, 2:], np.roll(edges[:, :2], -1, axis=0))


def test_a_wall_is_open_where_its_gap_is():
    world = World(wall((-3, 2), (3, 2), [(-0.5, 0.5)], thickness=0.2))
    assert np.isposinf(look(world, [0.0], beam=180)).all()
    sideways = look(world, [0.0], beam=150)  # 60 degrees: meets y = 1.9 at x = 1.1
    np.testing.assert_allclose(sideways, 1.9 / np.sin(np.deg2rad(60)))


def test_a_thing_stands_from_its_first_moment_until_just_before_its_last():
    world = World(np.empty((0, 4)), [Thing("crate", box(3.0, 0.0, 2.0, 2.0), since=2.0, until=4.0)])
    seen = look(world, [1.0, 2.0, 3.0, 4.0, 5.0])
    np.testing.assert_allclose(seen, [np.inf, 2.0, 2.0, np.inf, np.inf])


def test_glass_answers_head_on_and_lets_slanting_beams_through():
    glass = World(wall((5, -9), (5, 9), thickness=0.2), glass=np.array([[2.0, -9.0, 2.0, 9.0]]))
    assert look(glass, [0.0], beam=90) == pytest.approx(2.0)
    assert look(glass, [0.0], beam=120) == pytest.approx(4.9 / np.cos(np.deg2rad(30)))


def test_somebody_walking_is_seen_only_while_there():
    walk = Walk("visitor", np.array([1.0, 2.0]), np.array([[3.0, 0.0], [3.0, 0.0]]), 0.3, legs=False)
    np.testing.assert_allclose(
        look(World(np.empty((0, 4)), (), [walk]), [0.5, 1.5, 2.5]), [np.inf, 2.7, np.inf]
    )


def test_legs_stride_around_the_walker():
    walk = Walk("visitor", np.array([0.0, 10.0]), np.array([[0.0, 0.0], [10.0, 0.0]]))
    times = np.linspace(0, 9.9, 500)
    legs = walk.circles(times)
    np.testing.assert_allclose(legs.mean(axis=1), np.stack([times, 0 * times], axis=1), atol=1e-9)
    stride = legs[:, 0, 0] - legs[:, 1, 0]
    assert 0.5 < stride.max() < 0.6
    assert -0.6 < stride.min() < -0.5


def test_an_upside_down_laser_looks_to_the_right_where_an_upright_one_looks_to_the_left():
    mount = Mount(0.2, 0.1, 0.5, 30.0, upside_down=True)
    origins, bearings = scanner(mount=mount).rays(standing(1.0, 2.0, np.pi / 2).at(np.zeros((1, 181))))
    np.testing.assert_allclose(origins[0, 0], [1.0 - 0.1, 2.0 + 0.2])
    np.testing.assert_allclose(np.rad2deg(bearings[0, [0, 90, 180]]), [90 + 30 + 90, 120, 90 + 30 - 90])


@pytest.mark.parametrize("upside_down", [False, True])
def test_the_mount_s_quaternion_says_the_same_as_its_rays(upside_down):
    mount = Mount(0.0, 0.0, 0.0, 40.0, upside_down)
    _, bearings = scanner(mount=mount).rays(standing().at(np.zeros((1, 181))))
    x, y, z, w = mount.quaternion
    rotation = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z)],
        ]
    )
    beams = np.deg2rad(np.arange(-90.0, 91.0))
    np.testing.assert_allclose(
        rotation @ [np.cos(beams), np.sin(beams)], [np.cos(bearings[0]), np.sin(bearings[0])], atol=1e-12
    )


def test_beams_leave_one_after_the_other_while_the_robot_moves():
    motion = Motion(np.array([0.0, 10.0]), np.array([[0.0, 0.0, 0.0], [10.0, 0.0, 0.0]]))
    laser = scanner(sweep_time=0.181, noise=0.0, missing=0.0)
    ranges = laser.scan(World(wall((5, -9), (5, 9), thickness=0.2)), motion, np.array([1.0]), rng())
    assert ranges[0, 90] == pytest.approx(4.9 - 1.09, abs=1e-3)


def test_noise_has_the_stated_spread_and_no_bias():
    true = np.full((200, 181), 4.0)
    measured = scanner(noise=0.02, missing=0.0).measured(true, rng()).astype(float)
    assert abs((measured - true).mean()) < 4 * 0.02 / np.sqrt(true.size)
    assert (measured - true).std() == pytest.approx(0.02, rel=0.02)


def test_ranges_are_multiples_of_the_resolution():
    measured = scanner(resolution=1 / 256, missing=0.0).measured(np.full((2, 181), 4.0), rng())
    np.testing.assert_array_equal(measured * 256, np.round(measured * 256))


def test_the_stated_share_of_returns_is_missing():
    measured = scanner(missing=0.05).measured(np.full((300, 181), 4.0), rng())
    assert np.isposinf(measured).mean() == pytest.approx(0.05, abs=0.004)


def test_what_is_too_near_too_far_or_not_there_gets_the_no_return_code():
    laser = scanner(no_return=11.0, missing=0.0, noise=0.0)
    measured = laser.measured(np.array([[0.05, 0.1, 10.0, 10.1, np.inf]]), rng())
    np.testing.assert_allclose(measured, [[11.0, 0.1, 10.0, 11.0, 11.0]])


def test_a_scan_is_the_same_for_the_same_seed():
    world = World(wall((5, -9), (5, 9)))
    first, second = (scanner().scan(world, standing(), np.array([1.0, 2.0]), rng()) for _ in range(2))
    np.testing.assert_array_equal(first, second)
