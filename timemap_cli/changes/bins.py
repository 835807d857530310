"""When a range is another surface, and when it passes through one."""

import numpy as np

from timemap_cli.changes.rings import Bools, Floats
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
