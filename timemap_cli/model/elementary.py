"""Sines, arctangents and logarithms by arithmetic that rounds the same on every machine.

Those of the C library, of NumPy and of vector units differ in the last bit, and one bit decides on which side of a
border something falls. IEEE 754 fixes the results of + - * / and of the square root alone, so only those are used
here: plain power series, after the argument has been brought near zero. `angles` has a faster, coarser bearing.
"""

import math

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]

# A quarter turn in two parts: whole multiples of the first, up to 2^20 of them, are exact.
_QUARTER = round(math.pi / 2 * 2**32) / 2**32
_QUARTER_REST = 6.077100506506192e-11
_LN_2 = 0.6931471805599453
_HALVINGS = 3  # of the angle before its series: the tangent is then at most 0.1

_SINE = tuple((-1) ** k / math.factorial(2 * k + 1) for k in range(9))
_COSINE = tuple((-1) ** k / math.factorial(2 * k) for k in range(10))
_ARCTANGENT = tuple((-1) ** k / (2 * k + 1) for k in range(9))
_LOGARITHM = tuple(1 / (2 * k + 1) for k in range(11))


def cos_sin(angles: Floats) -> tuple[Floats, Floats]:
    """Cosine and sine of angles [rad] within 2^20 quarter turns, of any shape; the error is below 2e-16."""
    quarters = np.rint(angles * (2 / math.pi))
    rest = (angles - quarters * _QUARTER) - quarters * _QUARTER_REST
    square = rest * rest
    cosine, sine = _series(square, _COSINE), _series(square, _SINE) * rest
    turned = quarters % 4
    swapped = turned % 2 == 1
    x, y = np.where(swapped, sine, cosine), np.where(swapped, cosine, sine)
    return np.where((turned == 1) | (turned == 2), -x, x), np.where(turned >= 2, -y, y)


def bearings(x: Floats, y: Floats) -> Floats:
    """Bearing [rad] of points (x, y), counter-clockwise from +x, in [-pi, pi]; (0, 0) gives 0.

    The relative error is below 1e-15.
    """
    ax, ay = np.abs(x), np.abs(y)
    tangent = np.minimum(ax, ay) / np.maximum(np.maximum(ax, ay), np.finfo(np.float64).tiny)
    for _ in range(_HALVINGS):
        tangent = tangent / (1 + np.sqrt(1 + tangent * tangent))
    angle = _series(tangent * tangent, _ARCTANGENT) * tangent * 2**_HALVINGS
    angle = np.where(ay > ax, math.pi / 2 - angle, angle)
    return np.asarray(np.copysign(np.where(x < 0, math.pi - angle, angle), y))


def logarithms(values: Floats) -> Floats:
    """Natural logarithms of positive numbers of any shape; the error is below 1e-15, absolute or relative."""
    fraction, exponent = np.frexp(values)
    low = fraction < math.sqrt(0.5)
    fraction = np.where(low, 2 * fraction, fraction)
    ratio = (fraction - 1) / (fraction + 1)
    return np.asarray(2 * ratio * _series(ratio * ratio, _LOGARITHM) + (exponent - low) * _LN_2)


def distance(dx: float, dy: float) -> float:
    """Length of a vector (dx, dy); neither hypot nor ** rounds the same everywhere."""
    return math.sqrt(dx * dx + dy * dy)


def lengths(vectors: Floats) -> Floats:
    """Lengths (...) of vectors (..., 2)."""
    x, y = vectors[..., 0], vectors[..., 1]
    return np.asarray(np.sqrt(x * x + y * y))


def _series(x: Floats, coefficients: tuple[float, ...]) -> Floats:
    """The polynomial with these coefficients, that of x^0 first."""
    total = np.full(np.shape(x), coefficients[-1])
    for coefficient in coefficients[-2::-1]:
        total *= x
        total += coefficient
    return total
