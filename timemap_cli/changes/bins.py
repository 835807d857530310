"""Which angle bins show a thing on one side that the other side does not have."""

import numpy as np

from timemap_cli.changes.rings import Bools, Floats, Places, Rings
from timemap_cli.changes.rules import Rules


def step(nearer: Floats, rules: Rules) -> Floats:
    """How much farther a range must be to be another surface [m], same shape as the nearer range."""
    return np.maximum(rules.min_step_m, rules.min_step_share * nearer)


def seen_past(nearer: Floats, farther: Floats, radius: float, rules: Rules) -> Bools:
    """Where `farther` passes through the surface at `nearer`; false where either is NaN.

    Clear passes only through what stands well inside the radius.
    """
    by = step(nearer, rules)
    return (farther > nearer + by) & (np.isfinite(farther) | (nearer <= radius - rules.clear_margin * by))


def lost_bins(having: Rings, lacking: Rings, places: Places, rules: Rules) -> Bools:
    """Angle bins where `having` shows a surface that `lacking` sees past, (rows, angle_bins).

    A surface that `lacking` shows within `edge_deg` was only seen round an edge from a slightly other place.
    """
    firm = having.firm(rules, rules.min_samples) & lacking.firm(rules, rules.min_samples)
    lost = firm & seen_past(having.ranges, lacking.ranges, places.radius, rules)
    finite = np.where(np.isfinite(having.ranges), having.ranges, np.nan)
    by = step(finite, rules)
    for shift in range(-places.edge_bins(rules), places.edge_bins(rules) + 1):
        lost &= ~(np.abs(np.roll(lacking.ranges, shift, axis=1) - finite) <= by)
    return lost
