"""Rigid transforms as stacks of 3x4 matrices, and interpolation between poses.

A transform ``a_from_b`` (..., 3, 4) holds rotation and translation ``[R | t]``: it takes a point's
coordinates in b to its coordinates in a. Everything is spelled out in plain arithmetic, element by element,
so that a transform's value does not depend on how many others it is computed with, nor on the machine.
"""

from __future__ import annotations

import numpy as np

from timemap_cli.logs.batches import Float64s
from timemap_cli.model.elementary import bearings, cos_sin

IDENTITY: Float64s = np.eye(3, 4)
IDENTITY.flags.writeable = False


def from_translation_rotation(translation: Float64s, rotation: Float64s) -> Float64s:
    """Build transforms (..., 3, 4) from translations (..., 3) [m] and unit quaternions (..., 4) xyzw."""
    x, y, z, w = (rotation[..., k] for k in range(4))
    matrix = np.empty((*rotation.shape[:-1], 3, 4))
    matrix[..., 0, 0] = 1 - 2 * (y * y + z * z)
    matrix[..., 0, 1] = 2 * (x * y - z * w)
    matrix[..., 0, 2] = 2 * (x * z + y * w)
    matrix[..., 1, 0] = 2 * (x * y + z * w)
    matrix[..., 1, 1] = 1 - 2 * (x * x + z * z)
    matrix[..., 1, 2] = 2 * (y * z - x * w)
    matrix[..., 2, 0] = 2 * (x * z - y * w)
    matrix[..., 2, 1] = 2 * (y * z + x * w)
    matrix[..., 2, 2] = 1 - 2 * (x * x + y * y)
    matrix[..., 3] = translation
    return matrix


def compose(a_from_b: Float64s, b_from_c: Float64s) -> Float64s:
    """Return ``a_from_c`` (..., 3, 4); leading shapes are broadcast."""
    a_from_c = _rotate(a_from_b, b_from_c)
    a_from_c[..., 3] += a_from_b[..., 3]
    return a_from_c


def invert(a_from_b: Float64s) -> Float64s:
    """Return ``b_from_a`` (..., 3, 4)."""
    b_from_a = np.empty(a_from_b.shape)
    b_from_a[..., :3] = np.swapaxes(a_from_b[..., :3], -1, -2)
    b_from_a[..., 3] = -_rotate(b_from_a, a_from_b[..., 3:])[..., 0]
    return b_from_a


def apply(a_from_b: Float64s, points: Float64s) -> Float64s:
    """Return in a the points (..., k, 3) [m] given in b; leading shapes are broadcast."""
    columns = np.swapaxes(points, -1, -2)
    return np.swapaxes(_rotate(a_from_b, columns) + a_from_b[..., 3:], -1, -2)


def interpolate(
    translations: tuple[Float64s, Float64s], rotations: tuple[Float64s, Float64s], ratio: Float64s
) -> tuple[Float64s, Float64s]:
    """Return translations (n, 3) and unit quaternions (n, 4) at ``ratio`` (n,) from the first to the second.

    Straight line and shortest turn at constant rate (slerp), as tf2 does. Ratio 0 gives the first exactly.
    """
    share = ratio[:, None]
    translation = translations[0] + share * (translations[1] - translations[0])
    return translation, _slerp(rotations[0], rotations[1], share)


def _rotate(a_from_b: Float64s, columns: Float64s) -> Float64s:
    """Turn columns (..., 3, k) given in b into a; nothing is added."""
    return (
        a_from_b[..., 0:1] * columns[..., 0:1, :]
        + a_from_b[..., 1:2] * columns[..., 1:2, :]
        + a_from_b[..., 2:3] * columns[..., 2:3, :]
    )


def _slerp(first: Float64s, second: Float64s, share: Float64s) -> Float64s:
    # q and -q are the same rotation; the nearer of the two is the shorter way.
    nearer = second * np.where(_dot(first, second) < 0, -1.0, 1.0)
    # Unlike arccos of the dot product this is exact for small angles, which is what neighbouring poses have.
    angle = 2 * bearings(_length(nearer + first), _length(nearer - first))
    _, (sine, sine_first, sine_second) = cos_sin(np.stack((angle, (1 - share) * angle, share * angle)))
    straight = sine < 1e-9
    sine = np.where(straight, 1.0, sine)
    weight_first = np.where(straight, 1 - share, sine_first / sine)
    weight_second = np.where(straight, share, sine_second / sine)
    return weight_first * first + weight_second * nearer


def _dot(a: Float64s, b: Float64s) -> Float64s:
    product = a * b
    return product[:, 0:1] + product[:, 1:2] + product[:, 2:3] + product[:, 3:4]


def _length(a: Float64s) -> Float64s:
    return np.sqrt(_dot(a, a))
