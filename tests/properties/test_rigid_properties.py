import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from timemap_cli.logs import rigid

numbers = st.floats(-100, 100, allow_nan=False, width=32)


@st.composite
def transforms(draw):
    rotation = draw(
        arrays(float, (1, 4), elements=st.floats(-1, 1)).filter(lambda q: np.linalg.norm(q) > 1e-3)
    )
    translation = draw(arrays(float, (1, 3), elements=numbers))
    return rigid.from_translation_rotation(translation, rotation / np.linalg.norm(rotation))


@given(transforms())
def test_a_transform_and_its_inverse_cancel(a_from_b):
    for product in (
        rigid.compose(a_from_b, rigid.invert(a_from_b)),
        rigid.compose(rigid.invert(a_from_b), a_from_b),
    ):
        np.testing.assert_allclose(product[0], np.eye(3, 4), atol=1e-12)


@given(transforms(), transforms(), transforms())
def test_composition_is_associative(a_from_b, b_from_c, c_from_d):
    left = rigid.compose(rigid.compose(a_from_b, b_from_c), c_from_d)
    right = rigid.compose(a_from_b, rigid.compose(b_from_c, c_from_d))
    np.testing.assert_allclose(left, right, atol=1e-10)


@given(transforms(), arrays(float, (1, 4, 3), elements=numbers))
def test_distances_between_points_are_kept(a_from_b, points):
    moved = rigid.apply(a_from_b, points)
    before = np.linalg.norm(points[0, 1:] - points[0, 0], axis=1)
    np.testing.assert_allclose(np.linalg.norm(moved[0, 1:] - moved[0, 0], axis=1), before, atol=1e-10)


@given(transforms(), transforms(), arrays(float, (1, 4, 3), elements=numbers))
def test_composing_is_applying_one_after_the_other(a_from_b, b_from_c, points):
    once = rigid.apply(rigid.compose(a_from_b, b_from_c), points)
    np.testing.assert_allclose(once, rigid.apply(a_from_b, rigid.apply(b_from_c, points)), atol=1e-10)


@given(
    arrays(float, (2, 1, 4), elements=st.floats(-1, 1)).filter(
        lambda q: np.linalg.norm(q, axis=2).min() > 1e-3
    ),
    st.floats(0, 1),
)
def test_interpolated_rotations_are_rotations_that_share_out_the_angle(q, ratio):
    q /= np.linalg.norm(q, axis=2, keepdims=True)
    zero = np.zeros((1, 3))

    def angle(a, b):
        return 2 * np.arctan2(*(min(np.linalg.norm(a - s * b) for s in (1, -1)),
                                max(np.linalg.norm(a + s * b) for s in (1, -1)))) * 2  # fmt: skip

    _, between = rigid.interpolate((zero, zero), (q[0], q[1]), np.array([ratio]))
    np.testing.assert_allclose(np.linalg.norm(between), 1, atol=1e-9)
    np.testing.assert_allclose(angle(q[0], between), ratio * angle(q[0], q[1]), atol=1e-6)
