"""Whether what one side shows stands apart from all that the other side shows.

At a wall seen at a flat angle a pose that is a few centimetres off shifts ranges by more than any limit on ranges; its
points still lie on the wall.
"""

import numpy as np

from timemap_cli.changes.rings import Floats, Places, Rings
from timemap_cli.changes.rules import Rules
from timemap_cli.changes.runs import Run
from timemap_cli.model.elementary import lengths


def stands_apart(run: Run, lacking: Rings, places: Places, rules: Rules) -> bool:
    """True where enough of a run's bins to be a run lie farther than `min_apart_m` from the other side's surfaces."""
    ends = places.centres[run.row] + places.ends(lacking.ranges[run.row])
    apart = _distances(run.points, ends, rules.max_jump_m) > rules.min_apart_m
    return int(np.count_nonzero(apart)) >= rules.min_bins


def _distances(points: Floats, ends: Floats, joined_m: float) -> Floats:
    """Distance (n,) [m] of points (n, 2) from the nearest surface through the ends (angle_bins, 2) of a ring.

    Neighbouring ends closer than `joined_m` are joined; an end alone is a surface of its own. Inf where there is none.
    """
    along = np.roll(ends, -1, axis=0) - ends
    joined = lengths(along) < joined_m  # false where an end is NaN
    along = np.where(joined[:, None], along, 0.0)
    there = np.flatnonzero(~np.isnan(ends[:, 0]))
    if not len(there):
        return np.full(len(points), np.inf)
    ends, along = ends[there], along[there]
    offset = points[:, None] - ends
    share = (offset * along).sum(axis=2) / np.maximum((along * along).sum(axis=1), 1e-9)
    nearest = offset - np.clip(share, 0.0, 1.0)[..., None] * along
    return np.asarray(lengths(nearest).min(axis=1))
