"""The sides of the least rectangle round an outline."""

import numpy as np

from timemap_cli.changes.hull import MARGIN_M, hull
from timemap_cli.changes.rings import Floats
from timemap_cli.model.elementary import lengths
from timemap_cli.model.ordering import to_order


def rectangle_sides(points: Floats) -> tuple[float, float]:
    """Longer and shorter side [m] of the rectangle of least perimeter round points (n, 2).

    One side lies along their hull. Of a corner between two faces, the rectangle along the diagonal has the same area
    as the one along the faces, but a longer perimeter. Points on a line have a shorter side of nearly 0: one face of a
    thing was seen.
    """
    corners = hull(points)
    along = np.roll(corners, -1, axis=0) - corners
    along = along / lengths(along)[:, None]
    across = along[:, ::-1] * (-1.0, 1.0)
    widths = [_extent(corners, axes) for axes in (along, across)]
    least = min(range(len(along)), key=lambda i: (to_order(float(widths[0][i] + widths[1][i])), i))
    shorter, longer = sorted(float(width[least]) - 2 * MARGIN_M for width in widths)
    return longer, max(0.0, shorter)


def _extent(corners: Floats, axes: Floats) -> Floats:
    """How far corners (k, 2) reach along each of the unit vectors (m, 2), (m,) [m]."""
    place = corners[:, None, 0] * axes[:, 0] + corners[:, None, 1] * axes[:, 1]
    return np.asarray(place.max(axis=0) - place.min(axis=0))
