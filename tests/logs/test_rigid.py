import numpy as np
import pytest

from timemap_cli.logs import rigid

S = np.sqrt(0.5)


def pose(translation, rotation):
    return rigid.from_translation_rotation(np.array([translation], float), np.array([rotation], float))


@pytest.mark.parametrize(
    ("rotation", "expected"),
    [
        ((0, 0, S, S), (0, 1, 0)),  # a quarter turn to the left: x points to y
        ((0, 0, -S, S), (0, -1, 0)),
        ((0, S, 0, S), (0, 0, -1)),  # pitch 90 degrees: nose down
        ((1, 0, 0, 0), (1, 0, 0)),  # upside down about x: x stays
    ],
)
def test_quaternion_turns_the_x_axis(rotation, expected):
    points = rigid.apply(pose((0, 0, 0), rotation), np.array([[[1.0, 0, 0]]]))
    np.testing.assert_allclose(points[0, 0], expected, atol=1e-15)


def test_upside_down_mount_mirrors_left_and_right():
    left = np.array([[[0.0, 2.0, 0.0]]])
    seen = rigid.apply(pose((0.1, 0, 0.3), (1, 0, 0, 0)), left)
    np.testing.assert_allclose(seen[0, 0], (0.1, -2.0, 0.3), atol=1e-15)


def test_tilted_mount_shortens_the_way_ahead():
    # pitch of 30 degrees down: 2 m ahead are 2 cos 30 ahead and 2 sin 30 lower
    half = np.radians(15)
    seen = rigid.apply(pose((0, 0, 1.0), (0, np.sin(half), 0, np.cos(half))), np.array([[[2.0, 0, 0]]]))
    np.testing.assert_allclose(seen[0, 0], (2 * np.cos(np.radians(30)), 0, 0), atol=1e-15)


def test_compose_applies_the_right_hand_side_first():
    map_from_base = pose((10, 0, 0), (0, 0, S, S))
    base_from_laser = pose((1, 0, 0), (0, 0, S, S))
    map_from_laser = rigid.compose(map_from_base, base_from_laser)
    # the base looks along y, the laser one metre ahead of it and turned once more: along -x
    np.testing.assert_allclose(map_from_laser[0, :, 3], (10, 1, 0), atol=1e-15)
    np.testing.assert_allclose(map_from_laser[0, :, 0], (-1, 0, 0), atol=1e-15)


def test_invert_of_a_turned_and_shifted_frame():
    b_from_a = rigid.invert(pose((2, 3, 0), (0, 0, S, S)))
    # a's origin seen from b, which stands at (2, 3) and looks along y
    np.testing.assert_allclose(b_from_a[0, :, 3], (-3, 2, 0), atol=1e-15)


def test_interpolation_turns_the_short_way_at_constant_rate():
    first, second = np.array([[0, 0, 0, 1.0]]), np.array([[0, 0, -S, -S]])  # 90 degrees, other sign
    ends = np.array([[0.0, 0, 0]]), np.array([[4.0, 0, -2]])
    translation, rotation = rigid.interpolate(ends, (first, second), np.array([0.25]))
    np.testing.assert_allclose(translation, [[1, 0, -0.5]])
    half = np.radians(22.5 / 2)
    np.testing.assert_allclose(rotation, [[0, 0, np.sin(half), np.cos(half)]], atol=1e-15)


def test_interpolation_between_equal_rotations_is_that_rotation():
    q = np.array([[0.1, -0.2, 0.3, 0.9]])
    q /= np.linalg.norm(q)
    zero = np.zeros((1, 3))
    for other in (q, -q):
        _, rotation = rigid.interpolate((zero, zero), (q, other), np.array([0.7]))
        np.testing.assert_allclose(rotation, q, atol=1e-15)


def test_ratio_zero_gives_the_first_to_the_last_bit():
    generator = np.random.default_rng(0)
    q = generator.normal(size=(2, 50, 4))
    q /= np.linalg.norm(q, axis=2, keepdims=True)
    t = generator.normal(size=(2, 50, 3)) * 1e3
    translation, rotation = rigid.interpolate((t[0], t[1]), (q[0], q[1]), np.zeros(50))
    assert (translation == t[0]).all()
    assert (rotation == q[0]).all()


def test_a_transform_does_not_depend_on_its_neighbours():
    generator = np.random.default_rng(1)
    q = generator.normal(size=(2, 1001, 4))
    q /= np.linalg.norm(q, axis=2, keepdims=True)
    t = generator.normal(size=(2, 1001, 3))
    ratio = generator.uniform(size=1001)

    def chain(rows):
        ends = rigid.interpolate((t[0][rows], t[1][rows]), (q[0][rows], q[1][rows]), ratio[rows])
        a = rigid.from_translation_rotation(*ends)
        return rigid.compose(rigid.invert(a), rigid.from_translation_rotation(t[1][rows], q[1][rows]))

    together = chain(slice(None))
    alone = np.concatenate([chain(slice(k, k + 1)) for k in range(1001)])
    assert together.tobytes() == alone.tobytes()
