"""The offset at which most points fit a surface."""

from collections.abc import Callable

from timemap_cli.maps.fit import Fit, inliers, weakest_direction
from timemap_cli.maps.grid import Floats, sample
from timemap_cli.maps.icp import closest
from timemap_cli.maps.offset import Offset
from timemap_cli.maps.starts import likely_starts
from timemap_cli.maps.surface import FINE_M, Scales

_FEW = 600  # points to try a start with
_FITS_WELL = 0.8  # share of inliers beyond which no other start is tried
_STARTS = 5
_WIDE_STEPS, _FINE_STEPS, _LAST_STEPS = 8, 8, 12
_NEARLY_ALL = 0.9
_SLIDES_M = tuple(sign * tenths / 10 for tenths in range(1, 11) for sign in (-1, 1))
_CLEARLY_BETTER = 0.02  # share of the points
_OVERLAP = 0.5  # share of what could be compared at first that still can be


def best_offset(points: Floats, surface: Scales, pivots: list[tuple[float, float]]) -> Offset:
    """The offset that fits most of the points (n, 2) [m], thinned to cells of 5 cm, to the surface.

    The iteration starts where the points are. If that does not suffice it starts from likely places as well, turned
    about the pivots [m]; what it finds from there must fit clearly more points.
    """
    few = sample(points, _FEW, FINE_M)

    least = _OVERLAP * Fit.of(few, surface).compared

    def tried(start: Offset) -> Offset:
        return closest(few, surface.fine, closest(few, surface.wide, start, _WIDE_STEPS), _FINE_STEPS)

    def share(offset: Offset) -> float:
        fit = Fit.of(offset.moved(few), surface)
        return fit.share if fit.compared >= least else 0.0

    found = max((Offset(), tried(Offset())), key=share)
    if share(found) < _FITS_WELL:
        starts = likely_starts(few, surface.wide.points, pivots, _STARTS)
        found = _better(found, [tried(start) for start in starts], share)
    found = _refined(points, surface, found)
    other = _better(found, _slid(points, surface, found), share)
    return found if other == found else max((found, _refined(points, surface, other)), key=share)


def _refined(points: Floats, surface: Scales, start: Offset) -> Offset:
    """The last steps: with the closest pairs, or first with nearly all, whichever fits more points.

    The closest alone may all lie on walls along the shift, which fit as well half way.
    """
    most = closest(points, surface.fine, start, _LAST_STEPS, _NEARLY_ALL)
    ways = [closest(points, surface.fine, near, _LAST_STEPS) for near in (start, most)]
    return max((*ways, most), key=lambda way: _count(points, surface, way))


def _slid(points: Floats, surface: Scales, found: Offset) -> list[Offset]:
    """Offsets farther along the direction that the fit says least about.

    The end of a corridor is a small share of its walls, and none of it is among the closest pairs.
    """
    along = weakest_direction(found.moved(points), surface.fine)
    if along is None:
        return []
    return [found.then(Offset(way * along[0], way * along[1])) for way in _SLIDES_M]


def _better(found: Offset, others: list[Offset], share: Callable[[Offset], float]) -> Offset:
    """The best of the others if it fits clearly better, else the one found."""
    best = max(others, key=share, default=found)
    return best if share(best) > share(found) + _CLEARLY_BETTER else found


def _count(points: Floats, surface: Scales, offset: Offset) -> int:
    """How many points fit."""
    return int(inliers(offset.moved(points), surface.fine).sum())
